// SPDX-License-Identifier: Apache-2.0
// Reads the corners of a glTF primitive's triangles; the wall has checked every offset and index.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>
#include <tiny_gltf.h>

namespace photonloupe {

class PrimitiveReader {
public:
    PrimitiveReader(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

    std::uint32_t get_triangle_count() const { return m_triangle_count; }
    bool has_normals() const { return m_normals.has_value(); }

    // Vertex indices, counter-clockwise from outside in the primitive's own space.
    std::array<std::uint32_t, 3> read_corners(std::uint32_t triangle) const;
    glm::dvec3 read_position(std::uint32_t vertex) const { return read_vector(m_positions, vertex); }
    glm::dvec3 read_normal(std::uint32_t vertex) const { return read_vector(*m_normals, vertex); }

private:
    struct Column {
        const unsigned char* bytes = nullptr;
        std::size_t stride = 0;
        int component_type = 0;
        std::size_t count = 0;
    };

    static Column find_column(const tinygltf::Model& model, int accessor);
    static glm::dvec3 read_vector(const Column& column, std::uint32_t element);
    std::uint32_t read_vertex(std::uint32_t corner) const;

    Column m_positions;
    std::optional<Column> m_normals;
    std::optional<Column> m_indices;
    int m_mode = 0;
    std::uint32_t m_triangle_count = 0;
};

} // namespace photonloupe
