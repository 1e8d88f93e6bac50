// SPDX-License-Identifier: Apache-2.0
// The language's constants; X, Y, Z and E are variables (program.h).
#pragma once

#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

namespace photonloupe::script {

struct ConstantName {
    std::string_view name;
    double value = 0;
    bool is_integer = false;
};
inline constexpr ConstantName CONSTANT_NAMES[] = {
    {"Pi", std::numbers::pi}, {"PI", std::numbers::pi}, {"true", 1, true}, {"false", 0, true}};

inline std::optional<ConstantName> find_constant_name(std::string_view name) {
    for (const ConstantName& constant : CONSTANT_NAMES)
        if (constant.name == name)
            return constant;
    return std::nullopt;
}

inline std::vector<std::string_view> list_constant_names() {
    std::vector<std::string_view> names;
    for (const ConstantName& constant : CONSTANT_NAMES)
        names.push_back(constant.name);
    return names;
}

} // namespace photonloupe::script
