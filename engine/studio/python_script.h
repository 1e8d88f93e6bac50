// SPDX-License-Identifier: Apache-2.0
// "Copy as Python": the program that makes what the studio shows, by the public names.
#pragma once

#include <string>

#include "studio/state.h"

namespace photonloupe::studio {

// Pixels of the studio's renders: the view scales them.
inline constexpr std::uint32_t RENDER_WIDTH = 640;
inline constexpr std::uint32_t RENDER_HEIGHT = 480;

// Loads, traces, runs the script, relaxes, renders the view as it is, looks through the loupe, and plots the parallel
// coordinates. `parameters` are the names the script gave.
std::string write_python(const StudioState& state, const std::vector<std::string>& parameters = {});

} // namespace photonloupe::studio
