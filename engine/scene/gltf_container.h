// SPDX-License-Identifier: Apache-2.0
// Takes a scene file apart: tells .gltf from .glb by content and finds the JSON text and the binary chunk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/json_place.h"

namespace photonloupe {

// What to do about files of glTF 1.
constexpr const char* GLTF_1_REMEDY =
    "only glTF 2 is read: convert it with npx gltf-pipeline -i OLD.gltf -o NEW.gltf (.glb to .glb alike)";

struct GltfContainer {
    std::string_view json;
    std::optional<std::span<const unsigned char>> binary_chunk; // GLB's buffer 0
};

// A member of `extensions`; without a value where there is none.
JsonPlace find_extension(const JsonPlace& owner, const char* name);

// The first `byte_count` bytes of a regular file, or all of them (at most `limit`) when no count is given.
std::vector<unsigned char> read_file_bytes(const std::filesystem::path& path, std::optional<std::uint64_t> byte_count,
                                           std::uint64_t limit, const JsonPlace& place);

// Views into `bytes`; refuses what is neither glTF text nor a whole GLB.
GltfContainer split_container(std::span<const unsigned char> bytes, const JsonPlace& place);

// Parses the JSON text, after bounding its size and nesting.
Json parse_json(std::string_view text, const JsonPlace& place);

} // namespace photonloupe
