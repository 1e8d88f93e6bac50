// SPDX-License-Identifier: Apache-2.0
// Writes a file so that a reader, or a crash, meets the old content or the new one, never half of it.
#pragma once

#include <filesystem>
#include <span>

namespace photonloupe {

// Writes a temporary sibling, flushes it to the disk and renames it over `path`. Throws Error with the path and the
// system's reason, and leaves no temporary file behind.
void write_file_atomically(const std::filesystem::path& path, std::span<const unsigned char> bytes);

} // namespace photonloupe
