// SPDX-License-Identifier: Apache-2.0
// Reads the corners of a glTF primitive's triangles; the wall has checked every offset and index.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <tiny_gltf.h>

#include "scene/accessor_column.h"

namespace photonloupe {

class PrimitiveReader {
public:
    // `weights` are those of morph targets; missing ones are 0.
    PrimitiveReader(const tinygltf::Primitive& primitive, const std::vector<AccessorColumn>& columns,
                    const std::vector<double>& weights = {});

    std::uint32_t get_triangle_count() const { return m_triangle_count; }
    bool has_normals() const { return m_normals.bytes; }
    bool has_texcoords(std::size_t set) const { return m_texcoords.at(set).bytes; }
    bool has_colors() const { return m_colors.bytes; }

    // Vertex indices, counter-clockwise from outside in the primitive's own space.
    std::array<std::uint32_t, 3> read_corners(std::uint32_t triangle) const;
    glm::dvec3 read_position(std::uint32_t vertex) const {
        return read_morphed(m_positions, &Target::positions, vertex);
    }
    // Of any length, and perhaps not finite.
    glm::dvec3 read_normal(std::uint32_t vertex) const { return read_morphed(m_normals, &Target::normals, vertex); }
    // Numbers that are not finite are 0.
    glm::dvec2 read_texcoord(std::size_t set, std::uint32_t vertex) const {
        return glm::dvec2(read_finite(m_texcoords[set], vertex));
    }
    // Linear; alpha is 1 where the file has none.
    glm::dvec4 read_color(std::uint32_t vertex) const { return read_finite(m_colors, vertex); }

    // Joints of the node's skin that move a vertex, with weights that are not negative; unused ones have none.
    bool has_joints() const { return m_joints[0].bytes && m_weights[0].bytes; }
    struct Influence {
        std::uint32_t joint = 0;
        double weight = 0.0;
    };
    std::array<Influence, 8> read_influences(std::uint32_t vertex) const;

private:
    struct Target {
        AccessorColumn positions, normals;
        double weight = 0.0;
    };

    glm::dvec3 read_morphed(const AccessorColumn& column, AccessorColumn Target::* moved, std::uint32_t vertex) const;
    static glm::dvec3 read_vector(const AccessorColumn& column, std::uint32_t vertex) {
        return {column.read(vertex, 0), column.read(vertex, 1), column.read(vertex, 2)};
    }
    static glm::dvec4 read_finite(const AccessorColumn& column, std::uint32_t vertex);
    std::uint32_t read_vertex(std::uint32_t corner) const {
        return m_indices.bytes ? m_indices.read_unsigned(corner) : corner;
    }

    AccessorColumn m_positions, m_normals, m_colors, m_indices;
    std::array<AccessorColumn, 2> m_texcoords, m_joints, m_weights;
    std::vector<Target> m_targets; // those that move anything
    int m_mode = 0;
    std::uint32_t m_triangle_count = 0;
};

} // namespace photonloupe
