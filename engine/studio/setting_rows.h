// SPDX-License-Identifier: Apache-2.0
// Widgets for settings, drawn from their rows.
#pragma once

#include "core/settings.h"
#include "studio/workspace.h"

namespace photonloupe::studio::ui {

// A widget for each setting, two beside each other, named "<panel>/<setting>". `completed` are the same settings with
// what is automatic filled in, to be seen. Returns the name of the one that was changed now, or "".
std::string edit_settings(Workspace& workspace, const std::string& panel, const std::vector<Setting>& settings,
                          const std::vector<Setting>& completed);

} // namespace photonloupe::studio::ui
