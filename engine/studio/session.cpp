// SPDX-License-Identifier: Apache-2.0
// Writes the state as JSON and reads it back, refusing what it may not be.
#include "studio/session.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_place.h"
#include "core/setting_json.h"
#include "studio/session_fields.h"

namespace photonloupe::studio {
namespace {

constexpr int SESSION_VERSION = 2;
constexpr const char* FORMAT = "photonloupe session";
constexpr std::uintmax_t LARGEST_SESSION = 256u << 20;
constexpr std::size_t MOST_IDS = 1u << 28;

class Writer {
public:
    Writer(Json& target, const std::filesystem::path& folder) : m_target(target), m_folder(folder) {}

    template <class T, class... Limits>
    void field(const char* name, T& value, Limits...) {
        m_target[name] = value;
    }
    void field(const char* name, std::string& value, std::initializer_list<const char*>) { m_target[name] = value; }
    void settings(const std::vector<Setting>& settings) { m_target.update(write_json(settings)); }
    void member(const char* name, const std::vector<Setting>& settings) { m_target[name] = write_json(settings); }
    template <class T>
    void enumeration(const char* name, T& value, std::initializer_list<const char*> names, int first) {
        m_target[name] = names.begin()[static_cast<int>(value) - first];
    }
    template <class T>
    void member(const char* name, T& value) {
        Writer inner(m_target[name] = Json::object(), m_folder);
        visit(inner, value);
    }
    template <class T>
    void members(const char* name, std::vector<T>& values, std::size_t) {
        Json& list = m_target[name] = Json::array();
        for (T& value : values) {
            Writer inner(list.emplace_back(Json::object()), m_folder);
            visit(inner, value);
        }
    }
    void path(const char* name, std::string& value) {
        if (value.empty() || m_folder.empty()) {
            m_target[name] = value;
            return;
        }
        const std::filesystem::path relative = std::filesystem::path(value).lexically_relative(m_folder);
        const bool is_below = !relative.empty() && *relative.begin() != "..";
        m_target[name] = is_below ? relative.string() : value;
    }
    void ids(const char* name, Ids& value) { m_target[name] = value ? Json(*value) : Json(nullptr); }
    void ids_by_name(const char* name, std::map<std::string, Ids>& values, std::size_t, std::size_t) {
        Json& target = m_target[name] = Json::object();
        for (const auto& [key, chosen] : values)
            target[key] = chosen ? *chosen : std::vector<std::uint32_t>{};
    }

private:
    Json& m_target;
    const std::filesystem::path& m_folder;
};

[[noreturn]] void refuse_field(const std::string& where, const std::string& what) {
    throw Error("session: " + where + " " + what + "; save the session again, or mend the file");
}

class Reader {
public:
    Reader(const Json& source, std::string where, const std::filesystem::path& folder)
        : m_source(source), m_where(std::move(where)), m_folder(folder) {
        if (!source.is_object())
            refuse_field(m_where.empty() ? "the file" : m_where, "must be an object");
    }

    void field(const char* name, bool& value) {
        if (const Json* found = find(name)) {
            if (!found->is_boolean())
                refuse_field(place(name), "must be true or false");
            value = found->get<bool>();
        }
    }
    void field(const char* name, std::string& value, std::size_t longest) {
        if (const Json* found = find(name))
            value = take_text(*found, place(name), longest);
    }
    void field(const char* name, std::string& value, std::initializer_list<const char*> names) {
        if (const Json* found = find(name))
            value = names.begin()[take_choice(*found, place(name), names)];
    }
    template <class T>
    void enumeration(const char* name, T& value, std::initializer_list<const char*> names, int first) {
        if (const Json* found = find(name))
            value = static_cast<T>(first + static_cast<int>(take_choice(*found, place(name), names)));
    }
    void settings(const std::vector<Setting>& settings) {
        for (const Setting& setting : settings)
            if (const Json* found = find(setting.label().c_str()))
                if (const std::string fault = read_json(setting, *found); !fault.empty())
                    refuse_field(place(setting.label().c_str()), fault);
    }
    void member(const char* name, const std::vector<Setting>& settings) {
        if (const Json* found = find(name))
            Reader(*found, place(name), m_folder).settings(settings);
    }
    template <class T>
        requires std::is_arithmetic_v<T>
    void field(const char* name, T& value, double low, double high) {
        if (const Json* found = find(name))
            value = static_cast<T>(take_number(*found, place(name), low, high, std::is_integral_v<T>));
    }
    template <class T, std::size_t Size>
    void field(const char* name, std::array<T, Size>& values, double largest) {
        if (const Json* found = find(name))
            values = take_array<T, Size>(*found, place(name), largest);
    }
    void field(const char* name, std::vector<std::uint32_t>& values, std::size_t most) {
        if (const Json* found = find(name))
            values = take_ids(*found, place(name), most);
    }
    void field(const char* name, std::vector<std::string>& values, std::size_t most, std::size_t longest) {
        list(name, values, most, [&](const Json& entry) { return take_text(entry, place(name), longest); });
    }
    void field(const char* name, std::map<std::string, double>& values, double largest) {
        const Json* found = find(name);
        if (!found)
            return;
        require_object(*found, place(name), MOST_ENTRIES);
        values.clear();
        for (const auto& [key, number] : found->items())
            values[key] = take_number(number, place(name) + "." + quote_text(key), -largest, largest, false);
    }
    void field(const char* name, std::vector<std::array<float, 2>>& values, std::size_t most, double largest) {
        list(name, values, most, [&](const Json& entry) { return take_array<float, 2>(entry, place(name), largest); });
    }
    template <class T>
    void member(const char* name, T& value) {
        if (const Json* found = find(name)) {
            Reader inner(*found, place(name), m_folder);
            visit(inner, value);
        }
    }
    template <class T>
    void members(const char* name, std::vector<T>& values, std::size_t most) {
        list(name, values, most, [&](const Json& entry) {
            Reader inner(entry, place(name), m_folder);
            T value;
            visit(inner, value);
            return value;
        });
    }
    void path(const char* name, std::string& value) {
        field(name, value, 4096);
        if (value.find('\0') != std::string::npos)
            refuse_field(place(name), "must not hold a zero byte");
        if (value.empty() || m_folder.empty() || std::filesystem::path(value).is_absolute())
            return;
        const std::filesystem::path below = std::filesystem::path(value).lexically_normal();
        if (*below.begin() == "..")
            refuse_field(place(name), "must not leave the session's folder");
        value = (m_folder / below).string();
    }
    void ids(const char* name, Ids& value) {
        const Json* found = find(name);
        if (found && !found->is_null())
            value = take_selection(*found, place(name));
    }
    void ids_by_name(const char* name, std::map<std::string, Ids>& values, std::size_t most, std::size_t longest) {
        const Json* found = find(name);
        if (!found)
            return;
        require_object(*found, place(name), most);
        for (const auto& [key, chosen] : found->items()) {
            if (key.size() > longest)
                refuse_field(place(name), "has a name that is too long");
            values[key] = take_selection(chosen, place(name) + "." + quote_text(key));
        }
    }

private:
    template <class T, class Take>
    void list(const char* name, std::vector<T>& values, std::size_t most, const Take& take) {
        const Json* found = find(name);
        if (!found)
            return;
        require_list(*found, place(name), most);
        values.clear();
        for (const Json& entry : *found)
            values.push_back(take(entry));
    }
    const Json* find(const char* name) const {
        const auto found = m_source.find(name);
        return found == m_source.end() ? nullptr : &*found;
    }
    std::string place(const char* name) const { return m_where.empty() ? name : m_where + "." + name; }

    static void require_list(const Json& value, const std::string& where, std::size_t most) {
        if (!value.is_array())
            refuse_field(where, "must be a list");
        if (value.size() > most)
            refuse_field(where, "has more than " + std::to_string(most) + " entries");
    }
    static void require_object(const Json& value, const std::string& where, std::size_t most) {
        if (!value.is_object() || value.size() > most)
            refuse_field(where, "must be an object of at most " + std::to_string(most) + " entries");
    }
    static std::string take_text(const Json& value, const std::string& where, std::size_t longest) {
        if (!value.is_string())
            refuse_field(where, "must be a text");
        std::string text = value.get<std::string>();
        if (text.size() > longest)
            refuse_field(where, "is longer than " + std::to_string(longest) + " bytes");
        return text;
    }
    static double take_number(const Json& value, const std::string& where, double low, double high, bool is_whole) {
        if (!value.is_number())
            refuse_field(where, "must be a number");
        const double number = value.get<double>();
        if (!(number >= low && number <= high) || (is_whole && number != std::floor(number)))
            refuse_field(where, std::string("must be ") + (is_whole ? "a whole number" : "a number") + " from " +
                                    Json(low).dump() + " to " + Json(high).dump());
        return number;
    }
    template <class T, std::size_t Size>
    static std::array<T, Size> take_array(const Json& value, const std::string& where, double largest) {
        require_list(value, where, Size);
        if (value.size() != Size)
            refuse_field(where, "must be " + std::to_string(Size) + " numbers");
        std::array<T, Size> values;
        for (std::size_t i = 0; i < Size; ++i)
            values[i] = static_cast<T>(take_number(value[i], where, -largest, largest, false));
        return values;
    }
    static std::vector<std::uint32_t> take_ids(const Json& value, const std::string& where, std::size_t most) {
        require_list(value, where, most);
        std::vector<std::uint32_t> ids;
        for (const Json& entry : value)
            ids.push_back(static_cast<std::uint32_t>(take_number(entry, where, 0, 4294967294.0, true)));
        return ids;
    }
    // Ascending, each once, whatever the file says.
    static Ids take_selection(const Json& value, const std::string& where) {
        std::vector<std::uint32_t> ids = take_ids(value, where, MOST_IDS);
        std::sort(ids.begin(), ids.end());
        ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
        return std::make_shared<const std::vector<std::uint32_t>>(std::move(ids));
    }
    // Which of `names` it is.
    static std::size_t take_choice(const Json& value, const std::string& where,
                                   std::initializer_list<const char*> names) {
        const std::string given = take_text(value, where, LONGEST_NAME);
        std::string all;
        for (const char* const& known : names) {
            if (given == known)
                return static_cast<std::size_t>(&known - names.begin());
            all += (all.empty() ? "" : ", ") + std::string(known);
        }
        refuse_field(where, "is " + quote_text(given) + "; it must be one of " + all);
    }

    const Json& m_source;
    std::string m_where;
    const std::filesystem::path& m_folder;
};

// Version 1 said by odd values what is automatic: a flag of β, a limit of 0, thresholds that are equal.
void rewrite_first_version(Json& document) {
    for (const char* place : {"/relax/choices", "/relax/used"}) {
        const Json::json_pointer at(place);
        if (!document.contains(at) || !document[at].is_object())
            continue;
        Json& settings = document[at];
        if (settings.value("has_auto_beta", Json()) == Json(true))
            settings["beta"] = "auto";
        if (settings.value("limit", Json()) == Json(0))
            settings["limit"] = "none";
        const Json thresholds = settings.value("thresholds", Json());
        if (thresholds.is_array() && thresholds.size() == 2 && thresholds[0] == thresholds[1])
            settings["thresholds"] = "auto";
    }
}

std::filesystem::path find_folder(const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal().parent_path();
}

} // namespace

std::string write_state(const StudioState& state, const std::filesystem::path& folder) {
    Json document{{"format", FORMAT}, {"version", SESSION_VERSION}};
    Writer writer(document, folder);
    StudioState copy = state;
    visit(writer, copy);
    // A script's text may be anything a file held: bytes that are not UTF-8 become replacement characters.
    return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

StudioState read_state(const std::string& text, const std::filesystem::path& folder) {
    Json document = Json::parse(text, nullptr, false);
    if (document.is_discarded())
        throw Error("session: the file is not JSON; open a file that the studio saved");
    Reader reader(document, "", folder);
    std::string format;
    std::uint32_t version = 0;
    reader.field("format", format, LONGEST_NAME);
    reader.field("version", version, 0, 1e9);
    if (format != FORMAT)
        throw Error("session: the file is not a session; open a file that the studio saved");
    if (version < 1 || version > SESSION_VERSION)
        throw Error("session: version " + std::to_string(version) + " is not known, only 1 to " +
                    std::to_string(SESSION_VERSION) + "; open it with the program that saved it");
    if (version == 1)
        rewrite_first_version(document);
    StudioState state;
    visit(reader, state);
    return state;
}

void save_session(const std::filesystem::path& path, const StudioState& state) {
    const std::string text = write_state(state, find_folder(path));
    write_file_atomically(path, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

StudioState load_session(const std::filesystem::path& path) {
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    if (failed)
        throw Error("session: " + path.string() + " cannot be read: " + failed.message());
    if (size > LARGEST_SESSION)
        throw Error("session: " + path.string() + " is larger than any session");
    std::ifstream file(path, std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    if (!file.good() && !file.eof())
        throw Error("session: " + path.string() + " cannot be read");
    return read_state(text, find_folder(path));
}

} // namespace photonloupe::studio
