// SPDX-License-Identifier: Apache-2.0
// Where this user's caches of compiled kernels live.
#pragma once

#include <filesystem>

namespace photonloupe {

// PHOTONLOUPE_CACHE_DIR, else XDG_CACHE_HOME/photonloupe, else ~/.cache/photonloupe; made if absent.
// Empty when none can be written: everything works without, only slower.
std::filesystem::path find_cache_folder();

} // namespace photonloupe
