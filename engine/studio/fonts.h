// SPDX-License-Identifier: Apache-2.0
// The interface's two fonts, inside the program.
#pragma once

struct ImFont;

namespace photonloupe::studio {

struct Fonts {
    ImFont* text = nullptr;
    ImFont* code = nullptr; // of one width
};

// Adds them to the current ImGui context; `scale` is the monitor's.
Fonts load_fonts(float scale);

} // namespace photonloupe::studio
