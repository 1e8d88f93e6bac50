// SPDX-License-Identifier: Apache-2.0
// A stage's settings as rows that every surface is made of: Python, command line, sessions, panels, memo keys, manuals.
//
// A stage says `template <class Rows> void visit(Rows& row, Settings& s)` with a `row(s.member, {...})` for each member
// that can be told; `list_settings` gives them with their types left behind.
#pragma once

#include <array>
#include <concepts>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace photonloupe {

// What a setting holds, whatever its type: nothing, a flag, a number, several, or the name of a choice.
using SettingValue = std::variant<std::monostate, bool, double, std::vector<double>, std::string>;

enum class SettingKind { flag, count, number, numbers, choice };

struct SettingRange {
    double low = 0, high = 0;
    bool is_given() const { return low < high; }
};

struct SettingInfo {
    std::string name;
    std::string doc;                  // what it is, on one line
    SettingRange range{};             // of each number
    std::vector<std::string> choices; // in the order of the enumeration, which begins with 0
    std::string empty;                // what holding nothing is called: "auto", "none"; "": it always holds something
    std::string automatic;            // what "auto" stands for
    std::string alias;                // of options, sessions and panels, where the name does not say of what it is
    std::string symbol;               // as the papers have it
    std::string unit;
    SettingRange usual{};        // what a slider offers; none: it is typed in
    bool is_logarithmic = false; // the slider
    bool spreads = false;        // one number stands for all
    bool differs = false;        // two numbers, between which something lies
};

struct Setting {
    SettingInfo about;
    SettingKind kind = SettingKind::flag;
    std::size_t width = 1; // how many numbers
    void* place = nullptr; // the member
    SettingValue (*read)(const Setting&) = nullptr;
    void (*write)(const Setting&, const SettingValue&) = nullptr; // a value that may be held

    const std::string& label() const { return about.alias.empty() ? about.name : about.alias; }
};

// How a member's type is read and written.
template <class T>
struct SettingType;

template <>
struct SettingType<bool> {
    static constexpr SettingKind KIND = SettingKind::flag;
    static SettingValue read(const SettingInfo&, bool value) { return value; }
    static bool write(const SettingInfo&, const SettingValue& value) { return std::get<bool>(value); }
};

template <std::unsigned_integral T>
struct SettingType<T> {
    static constexpr SettingKind KIND = SettingKind::count;
    static SettingValue read(const SettingInfo&, T value) { return static_cast<double>(value); }
    static T write(const SettingInfo&, const SettingValue& value) { return static_cast<T>(std::get<double>(value)); }
};

template <>
struct SettingType<double> {
    static constexpr SettingKind KIND = SettingKind::number;
    static SettingValue read(const SettingInfo&, double value) { return value; }
    static double write(const SettingInfo&, const SettingValue& value) { return std::get<double>(value); }
};

template <std::size_t Width>
struct SettingType<std::array<double, Width>> {
    static constexpr SettingKind KIND = SettingKind::numbers;
    static constexpr std::size_t WIDTH = Width;
    static SettingValue read(const SettingInfo&, const std::array<double, Width>& values) {
        return std::vector<double>(values.begin(), values.end());
    }
    static std::array<double, Width> write(const SettingInfo&, const SettingValue& value) {
        std::array<double, Width> values;
        for (std::size_t i = 0; i < Width; ++i)
            values[i] = std::get<std::vector<double>>(value)[i];
        return values;
    }
};

template <class T>
    requires std::is_enum_v<T>
struct SettingType<T> {
    static constexpr SettingKind KIND = SettingKind::choice;
    static SettingValue read(const SettingInfo& about, T value) {
        return about.choices.at(static_cast<std::size_t>(value));
    }
    static T write(const SettingInfo& about, const SettingValue& value) {
        std::size_t index = 0;
        while (about.choices.at(index) != std::get<std::string>(value))
            ++index;
        return static_cast<T>(index);
    }
};

template <class T>
struct SettingType<std::optional<T>> : SettingType<T> {
    static SettingValue read(const SettingInfo& about, const std::optional<T>& value) {
        return value ? SettingType<T>::read(about, *value) : SettingValue{};
    }
    static std::optional<T> write(const SettingInfo& about, const SettingValue& value) {
        if (std::holds_alternative<std::monostate>(value))
            return std::nullopt;
        return SettingType<T>::write(about, value);
    }
};

class SettingRows {
public:
    template <class T>
    void operator()(T& member, SettingInfo about) {
        using Type = SettingType<T>;
        Setting setting{std::move(about), Type::KIND};
        if constexpr (requires { Type::WIDTH; })
            setting.width = Type::WIDTH;
        setting.place = &member;
        setting.read = [](const Setting& of) { return Type::read(of.about, *static_cast<const T*>(of.place)); };
        setting.write = [](const Setting& of, const SettingValue& value) {
            *static_cast<T*>(of.place) = Type::write(of.about, value);
        };
        m_rows.push_back(std::move(setting));
    }

    std::vector<Setting> take() { return std::move(m_rows); }

private:
    std::vector<Setting> m_rows;
};

// The rows of settings that outlive them.
template <class Settings>
std::vector<Setting> list_settings(Settings& settings) {
    SettingRows rows;
    visit(rows, settings);
    return rows.take();
}

// The row of that name. Throws Error where there is none.
const Setting& find_setting(const std::vector<Setting>& settings, const std::string& name);

// Why the setting may not hold the value, as what follows its name; empty: it may.
std::string find_fault(const Setting& setting, const SettingValue& value);

// Makes the setting hold the value, which may be the name of holding nothing, or one number for all; a fault, as what
// follows its name, leaves it as it was.
std::string try_setting(const Setting& setting, SettingValue value);
// The same; throws Error, naming the setting.
void write_setting(const Setting& setting, SettingValue value);

// The value as text: of memo keys, in messages and programs.
std::string write_text(const SettingValue& value);
std::string write_text(const Setting& setting);

// Throws Error, naming who was told, where a setting holds what it may not.
void require_settings(const char* of, const std::vector<Setting>& settings);

template <class Settings>
void require_settings(const char* of, Settings settings) {
    require_settings(of, list_settings(settings));
}

// All settings in one line that differs where one of them does.
std::string write_key(const std::vector<Setting>& settings);

template <class Settings>
std::string write_settings(Settings settings) {
    return write_key(list_settings(settings));
}

} // namespace photonloupe
