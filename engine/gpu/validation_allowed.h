// SPDX-License-Identifier: Apache-2.0
// Validation messages that are let through, each with the reason; anything not listed here fails.
#pragma once

#include <array>
#include <string_view>

namespace photonloupe::gpu {

struct AllowedMessage {
    std::string_view id;     // the message id name the layer prints
    std::string_view reason; // why it is not our mistake
};

inline constexpr std::array<AllowedMessage, 0> ALLOWED_MESSAGES{};

} // namespace photonloupe::gpu
