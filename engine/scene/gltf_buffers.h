// SPDX-License-Identifier: Apache-2.0
// Reads the buffers of a scene file: embedded, from files below its folder, or the GLB's binary chunk.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "core/json_place.h"

namespace photonloupe {

using BufferBytes = std::vector<std::vector<unsigned char>>;

// Reads every buffer, each cut to its byteLength.
BufferBytes read_buffers(const JsonPlace& root, const std::filesystem::path& folder,
                         std::optional<std::span<const unsigned char>> binary_chunk);

} // namespace photonloupe
