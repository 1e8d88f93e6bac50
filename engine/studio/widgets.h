// SPDX-License-Identifier: Apache-2.0
// Widgets whose places are known by name, and which change the state by commands.
#pragma once

#include <string>
#include <vector>

#include "core/settings.h"
#include "studio/workspace.h"

namespace photonloupe::studio::ui {

// Remembers where the last item was drawn, as far as it is in sight.
void mark(Workspace& workspace, const std::string& name);
// Explains the last item while the mouse rests on it.
void explain(const char* text);

// The next item stands beside the last, so wide before the window's scale.
void beside(const Workspace& workspace, float width);

bool button(Workspace& workspace, const std::string& name, const char* label, const char* about = nullptr);
// True: `value` was changed; so of the others.
bool toggle(Workspace& workspace, const std::string& name, const char* label, bool& value, const char* about = nullptr);
bool choose(Workspace& workspace, const std::string& name, const char* label, std::string& value,
            const std::vector<std::string>& entries, const char* about = nullptr);
// A column of the photons in view.
bool choose_column(Workspace& workspace, const std::string& name, const char* label, std::string& value,
                   const char* extra = nullptr);
bool slide(Workspace& workspace, const std::string& name, const char* label, float& value, float low, float high,
           const char* format = "%.3g", bool is_logarithmic = false);
bool slide(Workspace& workspace, const std::string& name, const char* label, std::uint32_t& value, std::uint32_t low,
           std::uint32_t high, bool is_logarithmic = false);

// A widget for each setting, two beside each other, named "<panel>/<setting>". `completed` are the same settings with
// what is automatic filled in, to be seen. Returns the name of the one that was changed now, or "".
std::string edit_settings(Workspace& workspace, const std::string& panel, const std::vector<Setting>& settings,
                          const std::vector<Setting>& completed);

// A panel that has nothing to show says why and what to do.
void say_empty(const std::string& text);

} // namespace photonloupe::studio::ui
