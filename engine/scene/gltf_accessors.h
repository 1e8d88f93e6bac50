// SPDX-License-Identifier: Apache-2.0
// Checks buffers, buffer views and accessors against the bytes that are really there.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/json_place.h"

namespace photonloupe {

// An accessor whose every element lies inside its buffer.
struct AccessorSpan {
    JsonPlace place;
    std::string type;                 // "SCALAR", "VEC3", …
    std::uint64_t component_type = 0; // as in glTF: 5126 is float
    bool is_normalized = false;
    bool is_sparse = false;
    bool has_bytes = false; // without a buffer view glTF means zeros
    std::uint64_t count = 0;
    std::uint64_t stride = 0;
    std::size_t buffer = 0;
    std::uint64_t offset = 0; // of the first element in the buffer
};

constexpr std::uint64_t COMPONENT_BYTE = 5120;
constexpr std::uint64_t COMPONENT_UNSIGNED_BYTE = 5121;
constexpr std::uint64_t COMPONENT_SHORT = 5122;
constexpr std::uint64_t COMPONENT_UNSIGNED_SHORT = 5123;
constexpr std::uint64_t COMPONENT_UNSIGNED_INT = 5125;
constexpr std::uint64_t COMPONENT_FLOAT = 5126;

using BufferBytes = std::vector<std::vector<unsigned char>>;

// Reads every buffer, each cut to its byteLength.
BufferBytes read_buffers(const JsonPlace& root, const std::filesystem::path& folder,
                         std::optional<std::span<const unsigned char>> binary_chunk);

// Checks all accessors, and the buffer views they use.
std::vector<AccessorSpan> check_accessors(const JsonPlace& root, const BufferBytes& buffers);

// The document's part that describes approved accessors: one buffer view each.
void write_accessors(const std::vector<AccessorSpan>& accessors, const BufferBytes& buffers, Json& approved);

// Name under which a buffer is handed on.
std::string name_buffer(std::size_t index);

} // namespace photonloupe
