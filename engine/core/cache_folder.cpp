// SPDX-License-Identifier: Apache-2.0
// Finds and makes the per-user cache folder.
#include "core/cache_folder.h"

#include <cstdlib>

#include <unistd.h>

namespace photonloupe {

std::filesystem::path find_cache_folder() {
    std::filesystem::path folder;
    if (const char* own = std::getenv("PHOTONLOUPE_CACHE_DIR"); own && *own)
        folder = own;
    else if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg)
        folder = std::filesystem::path(xdg) / "photonloupe";
    else if (const char* home = std::getenv("HOME"); home && *home)
        folder = std::filesystem::path(home) / ".cache" / "photonloupe";
    else
        return {};
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || access(folder.c_str(), W_OK) != 0)
        return {};
    return folder;
}

} // namespace photonloupe
