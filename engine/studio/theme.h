// SPDX-License-Identifier: Apache-2.0
// The look of the interface: quiet greys, so that colors belong to the data.
#pragma once

#include <cstdint>

namespace photonloupe::studio {

// Of the current ImGui and ImPlot contexts.
void apply_theme(float scale);

// ImGui's packed colors of what every view marks alike; none is told apart by red against green.
inline constexpr std::uint32_t ACCENT_COLOR = 0xffffb050;  // selection, cursor: light blue
inline constexpr std::uint32_t WARNING_COLOR = 0xff40b0ff; // amber
inline constexpr std::uint32_t ALONG_COLOR = 0xff50c8ff;   // u_b: amber
inline constexpr std::uint32_t ACROSS_COLOR = 0xffffa040;  // v_b: blue
inline constexpr std::uint32_t PATH_COLOR = 0xb0e8e8e8;
inline constexpr std::uint32_t DIM_COLOR = 0xff909090;

} // namespace photonloupe::studio
