// SPDX-License-Identifier: Apache-2.0
// Sessions: the state as JSON and back, in a file that a killed save leaves whole.
#pragma once

#include <filesystem>

#include "studio/state.h"

namespace photonloupe::studio {

// Indented JSON; paths that lie below `folder` are written relative to it.
std::string write_state(const StudioState& state, const std::filesystem::path& folder);

// Throws Error naming what is wrong: not JSON, of a newer version, a value out of its range, a path that is too long.
// Relative paths are taken from `folder`. What is absent keeps its default.
StudioState read_state(const std::string& text, const std::filesystem::path& folder);

void save_session(const std::filesystem::path& path, const StudioState& state);
StudioState load_session(const std::filesystem::path& path);

} // namespace photonloupe::studio
