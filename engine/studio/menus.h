// SPDX-License-Identifier: Apache-2.0
// Small menus that several panels share: named selections, and figures as files.
#pragma once

#include "studio/workspace.h"

namespace photonloupe::studio {

// A button whose menu names the selection, chooses a named one, or clears it.
void draw_selection_menu(Workspace& workspace);
// A button whose menu writes a panel as a picture.
void draw_export_menu(Workspace& workspace);
// What an earlier program left when it ended unexpectedly.
void draw_restore_offer(Workspace& workspace);

} // namespace photonloupe::studio
