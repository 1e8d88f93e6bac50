// SPDX-License-Identifier: Apache-2.0
// A column of vectors as a glTF accessor stores it: floats or integers, packed or interleaved, aligned or not.
#pragma once

#include <cstdint>

namespace photonloupe {

constexpr std::uint64_t COMPONENT_BYTE = 5120;
constexpr std::uint64_t COMPONENT_UNSIGNED_BYTE = 5121;
constexpr std::uint64_t COMPONENT_SHORT = 5122;
constexpr std::uint64_t COMPONENT_UNSIGNED_SHORT = 5123;
constexpr std::uint64_t COMPONENT_UNSIGNED_INT = 5125;
constexpr std::uint64_t COMPONENT_FLOAT = 5126;

// The name under which indices go past the glTF parser, which sees no bytes and would miss theirs.
constexpr const char* INDICES = "_INDICES";

// A view of bytes that were checked: every element lies inside them.
struct AccessorColumn {
    const unsigned char* bytes = nullptr; // nothing for accessors that are not used
    std::uint64_t stride = 0;
    std::uint64_t element_bytes = 0;
    std::uint64_t count = 0;
    std::uint64_t component_type = COMPONENT_FLOAT;
    std::uint32_t width = 1; // components per element
    bool is_normalized = false;

    // glTF 2.0, section 3.6.2.2: normalized integers stand for [0, 1] or [-1, 1].
    double read(std::uint64_t element, std::uint32_t component) const;
    bool is_unsigned() const {
        return component_type == COMPONENT_UNSIGNED_BYTE || component_type == COMPONENT_UNSIGNED_SHORT ||
               component_type == COMPONENT_UNSIGNED_INT;
    }
    // Of columns that hold unsigned integers: indices and joints.
    std::uint32_t read_unsigned(std::uint64_t element, std::uint32_t component = 0) const;
};

} // namespace photonloupe
