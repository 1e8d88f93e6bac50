// SPDX-License-Identifier: Apache-2.0
// Settings to and from JSON.
#include "core/setting_json.h"

#include <nlohmann/json.hpp>

#include "core/error.h"

namespace photonloupe {
namespace {

// Nothing where JSON has what no setting holds.
std::optional<SettingValue> take_value(const Json& given) {
    if (given.is_boolean())
        return given.get<bool>();
    if (given.is_number())
        return given.get<double>();
    if (given.is_string())
        return given.get<std::string>();
    if (!given.is_array())
        return std::nullopt;
    std::vector<double> numbers;
    for (const Json& entry : given) {
        if (!entry.is_number())
            return std::nullopt;
        numbers.push_back(entry.get<double>());
    }
    return numbers;
}

} // namespace

Json write_json(const Setting& setting) {
    const SettingValue value = setting.read(setting);
    if (std::holds_alternative<std::monostate>(value))
        return setting.about.empty;
    if (setting.kind == SettingKind::count)
        return static_cast<std::uint64_t>(std::get<double>(value));
    return std::visit(
        [](const auto& held) -> Json {
            if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::monostate>)
                return nullptr;
            else
                return held;
        },
        value);
}

Json write_json(const std::vector<Setting>& settings) {
    Json written = Json::object();
    for (const Setting& setting : settings)
        written[setting.label()] = write_json(setting);
    return written;
}

std::string read_json(const Setting& setting, const Json& given) {
    const std::optional<SettingValue> value = take_value(given);
    if (!value)
        return "is not what it may be";
    return try_setting(setting, *value);
}

} // namespace photonloupe
