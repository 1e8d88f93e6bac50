// SPDX-License-Identifier: Apache-2.0
// Checked reading of JSON values: wrong kinds, ranges and indices are refused by place.
#include "core/json_place.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "core/error.h"

namespace photonloupe {
namespace {

// Enough to recognize a name; more would let a file flood the terminal.
constexpr std::size_t MAX_QUOTED_LENGTH = 80;
constexpr const char* REMEDY = "repair the file or export it again";

std::string format_number(double value) {
    return Json(value).dump();
}

bool is_utf8_continuation(char c) {
    return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u;
}

} // namespace

void refuse(const JsonPlace& place, std::string_view what, std::string_view remedy) {
    std::string message = *place.file + ": ";
    if (!place.path.empty())
        message += place.path + ": ";
    throw SceneError(message + std::string(what) + "; " + std::string(remedy));
}

std::string quote_text(std::string_view text) {
    std::size_t length = std::min(text.size(), MAX_QUOTED_LENGTH);
    while (length < text.size() && length > 0 && is_utf8_continuation(text[length]))
        --length;
    std::string quoted = "\"";
    for (const char c : text.substr(0, length)) {
        const auto code = static_cast<unsigned char>(c);
        quoted += code < 0x20 || code == 0x7F ? '?' : c;
    }
    return quoted + (length < text.size() ? "…\"" : "\"");
}

JsonPlace find_member(const JsonPlace& object, const char* key) {
    JsonPlace member{nullptr, object.path + "/" + key, object.file};
    if (!object.value)
        return member;
    if (!object.value->is_object())
        refuse(object, "an object was expected", REMEDY);
    const auto found = object.value->find(key);
    if (found != object.value->end())
        member.value = &*found;
    return member;
}

JsonPlace require_member(const JsonPlace& object, const char* key) {
    JsonPlace member = find_member(object, key);
    if (!member.value)
        refuse(object, std::string("\"") + key + "\" is missing", REMEDY);
    return member;
}

JsonPlace get_element(const JsonPlace& array, std::size_t index) {
    return {&array.value->at(index), array.path + "/" + std::to_string(index), array.file};
}

std::size_t count_elements(const JsonPlace& array, std::size_t limit) {
    if (!array.value)
        return 0;
    if (!array.value->is_array())
        refuse(array, "an array was expected", REMEDY);
    const std::size_t size = array.value->size();
    if (size > limit)
        refuse(array, std::to_string(size) + " entries, at most " + std::to_string(limit) + " are accepted",
               "split the scene");
    return size;
}

std::uint64_t read_unsigned(const JsonPlace& place, std::uint64_t limit) {
    // Whole numbers above 2^53 can't be told apart as doubles; every limit is far below.
    constexpr double EXACT = 9007199254740992.0;
    const Json& value = *place.value;
    std::optional<std::uint64_t> number;
    if (value.is_number_unsigned())
        number = value.get<std::uint64_t>();
    else if (value.is_number_float() && value.get<double>() >= 0 && value.get<double>() <= EXACT &&
             value.get<double>() == std::floor(value.get<double>()))
        number = std::uint64_t(value.get<double>());
    if (!number)
        refuse(place, "a whole number of 0 or more was expected", REMEDY);
    if (*number > limit)
        refuse(place, std::to_string(*number) + " is more than the " + std::to_string(limit) + " accepted here",
               REMEDY);
    return *number;
}

std::uint64_t read_unsigned_or(const JsonPlace& place, std::uint64_t limit, std::uint64_t fallback) {
    return place.value ? read_unsigned(place, limit) : fallback;
}

std::optional<std::uint32_t> read_index(const JsonPlace& place, std::size_t count, std::string_view what) {
    if (!place.value)
        return std::nullopt;
    const std::uint64_t index = read_unsigned(place, std::numeric_limits<std::uint64_t>::max());
    if (index >= count)
        refuse(place,
               "there is no " + std::string(what) + " " + std::to_string(index) + ", the file has " +
                   std::to_string(count),
               REMEDY);
    return std::uint32_t(index);
}

double read_number(const JsonPlace& place, NumberRange range) {
    if (!place.value->is_number())
        refuse(place, "a number was expected", REMEDY);
    const double value = place.value->get<double>();
    if (!(value >= range.lo && value <= range.hi))
        refuse(place, format_number(value) + " is outside " + format_number(range.lo) + " … " + format_number(range.hi),
               "set it to a value in this range");
    return value;
}

double read_number_or(const JsonPlace& place, double fallback, NumberRange range) {
    return place.value ? read_number(place, range) : fallback;
}

std::vector<double> read_numbers_or(const JsonPlace& place, std::vector<double> fallback, NumberRange range) {
    if (!place.value)
        return fallback;
    if (!place.value->is_array() || place.value->size() != fallback.size())
        refuse(place, "an array of " + std::to_string(fallback.size()) + " numbers was expected", REMEDY);
    std::vector<double> numbers;
    for (std::size_t i = 0; i < fallback.size(); ++i)
        numbers.push_back(read_number(get_element(place, i), range));
    return numbers;
}

std::string read_string(const JsonPlace& place) {
    if (!place.value->is_string())
        refuse(place, "a string was expected", REMEDY);
    return place.value->get<std::string>();
}

bool read_flag_or(const JsonPlace& place, bool fallback) {
    if (place.value && !place.value->is_boolean())
        refuse(place, "expected true or false", "correct the value");
    return place.value ? place.value->get<bool>() : fallback;
}

std::string read_string_or(const JsonPlace& place, std::string_view fallback) {
    return place.value ? read_string(place) : std::string(fallback);
}

} // namespace photonloupe
