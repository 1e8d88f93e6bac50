// SPDX-License-Identifier: Apache-2.0
// Checks values of settings and writes them as text.
#include "core/settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "core/json_place.h"

namespace photonloupe {
namespace {

std::string write_number(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr}; // the shortest that reads back as it
}

std::string say_range(const SettingRange& range) {
    return "must be from " + write_number(range.low) + " to " + write_number(range.high);
}

std::string find_number_fault(const Setting& setting, double value) {
    const SettingRange& range = setting.about.range;
    const bool is_whole = setting.kind != SettingKind::count || value == std::floor(value);
    if (value >= range.low && value <= range.high && is_whole)
        return "";
    return say_range(range) + (is_whole ? "" : ", a whole number") + ", not " + write_number(value);
}

std::string find_choice_fault(const Setting& setting, const std::string& given) {
    const std::vector<std::string>& choices = setting.about.choices;
    if (std::find(choices.begin(), choices.end(), given) != choices.end())
        return "";
    std::string names = setting.about.empty;
    for (const std::string& choice : choices)
        names += (names.empty() ? "" : ", ") + choice;
    return "must be one of " + names + ", not " + quote_text(given);
}

std::string find_numbers_fault(const Setting& setting, const std::vector<double>& values) {
    if (values.size() != setting.width)
        return "must be " + std::to_string(setting.width) + " numbers";
    for (const double value : values)
        if (std::string fault = find_number_fault(setting, value); !fault.empty())
            return fault;
    if (setting.about.differs && values[0] == values[1])
        return "must be two different numbers, not both " + write_number(values[0]);
    return "";
}

} // namespace

const Setting& find_setting(const std::vector<Setting>& settings, const std::string& name) {
    const auto found = std::find_if(settings.begin(), settings.end(),
                                    [&](const Setting& setting) { return setting.about.name == name; });
    if (found == settings.end())
        throw Error("there is no setting " + name);
    return *found;
}

std::string find_fault(const Setting& setting, const SettingValue& value) {
    if (std::holds_alternative<std::monostate>(value))
        return setting.about.empty.empty() ? "must be given" : "";
    switch (setting.kind) {
    case SettingKind::flag:
        return std::holds_alternative<bool>(value) ? "" : "must be true or false";
    case SettingKind::count:
    case SettingKind::number:
        if (const auto* number = std::get_if<double>(&value))
            return find_number_fault(setting, *number);
        return setting.kind == SettingKind::count ? "must be a whole number" : "must be a number";
    case SettingKind::numbers:
        if (const auto* numbers = std::get_if<std::vector<double>>(&value))
            return find_numbers_fault(setting, *numbers);
        return "must be " + std::to_string(setting.width) + " numbers";
    case SettingKind::choice:
        if (const auto* name = std::get_if<std::string>(&value))
            return find_choice_fault(setting, *name);
        return "must be a name";
    }
    return "";
}

std::string try_setting(const Setting& setting, SettingValue value) {
    const auto* name = std::get_if<std::string>(&value);
    if (name && !name->empty() && *name == setting.about.empty)
        value = {};
    if (const auto* number = std::get_if<double>(&value); number && setting.about.spreads)
        value = std::vector<double>(setting.width, *number);
    std::string fault = find_fault(setting, value);
    if (fault.empty())
        setting.write(setting, value);
    return fault;
}

void write_setting(const Setting& setting, SettingValue value) {
    if (const std::string fault = try_setting(setting, std::move(value)); !fault.empty())
        throw Error(setting.about.name + " " + fault);
}

void require_settings(const char* of, const std::vector<Setting>& settings) {
    for (const Setting& setting : settings)
        if (const std::string fault = find_fault(setting, setting.read(setting)); !fault.empty())
            throw Error(std::string(of) + ": " + setting.about.name + " " + fault);
}

std::string write_text(const SettingValue& value) {
    if (const auto* flag = std::get_if<bool>(&value))
        return *flag ? "true" : "false";
    if (const auto* number = std::get_if<double>(&value))
        return write_number(*number);
    if (const auto* name = std::get_if<std::string>(&value))
        return *name;
    std::string text;
    if (const auto* numbers = std::get_if<std::vector<double>>(&value))
        for (const double number : *numbers)
            text += (text.empty() ? "" : ", ") + write_number(number);
    return text;
}

std::string write_text(const Setting& setting) {
    const SettingValue value = setting.read(setting);
    return std::holds_alternative<std::monostate>(value) ? setting.about.empty : write_text(value);
}

std::string write_key(const std::vector<Setting>& settings) {
    std::string key;
    for (const Setting& setting : settings)
        key += setting.about.name + "=" + write_text(setting) + "/";
    return key;
}

} // namespace photonloupe
