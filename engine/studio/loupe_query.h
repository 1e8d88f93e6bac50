// SPDX-License-Identifier: Apache-2.0
// Asks the loupe's question again when the cursor, a choice or the photons changed.
#pragma once

#include "studio/workspace.h"

namespace photonloupe::studio {

// Moves the loupe; not a command: undo does not follow the mouse.
// `normal` of the surface there, if it is known.
void move_loupe(Workspace& workspace, const std::array<double, 3>& point, const std::optional<glm::vec3>& normal);

// Fills `loupe` and `pinned` of the workspace where they are out of date.
void update_loupe(Workspace& workspace);

} // namespace photonloupe::studio
