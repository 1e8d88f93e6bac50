// SPDX-License-Identifier: Apache-2.0
// Corners of triangles, strips and fans, indexed or not.
#include "scene/primitive_reader.h"

#include <algorithm>
#include <cmath>

namespace photonloupe {

PrimitiveReader::PrimitiveReader(const tinygltf::Primitive& primitive, const std::vector<AccessorColumn>& columns,
                                 const std::vector<double>& weights)
    : m_mode(primitive.mode) {
    const auto find_in = [&](const std::map<std::string, int>& attributes, const char* name) {
        const auto found = attributes.find(name);
        return found == attributes.end() ? AccessorColumn{} : columns.at(std::size_t(found->second));
    };
    const auto find_column = [&](const char* name) { return find_in(primitive.attributes, name); };
    m_positions = find_column("POSITION");
    m_normals = find_column("NORMAL");
    m_texcoords = {find_column("TEXCOORD_0"), find_column("TEXCOORD_1")};
    m_colors = find_column("COLOR_0");
    m_colors.is_normalized = true; // glTF has no other integers here; some exporters leave the flag out
    m_joints = {find_column("JOINTS_0"), find_column("JOINTS_1")};
    m_weights = {find_column("WEIGHTS_0"), find_column("WEIGHTS_1")};
    for (AccessorColumn& column : m_weights)
        column.is_normalized = true;
    for (std::size_t i = 0; i < std::min(weights.size(), primitive.targets.size()); ++i)
        if (weights[i] != 0)
            m_targets.push_back(
                {find_in(primitive.targets[i], "POSITION"), find_in(primitive.targets[i], "NORMAL"), weights[i]});
    m_indices = find_column(INDICES);
    const auto corner_count = std::uint32_t(m_indices.bytes ? m_indices.count : m_positions.count);
    m_triangle_count = m_mode == TINYGLTF_MODE_TRIANGLES ? corner_count / 3 : corner_count - 2;
}

std::array<std::uint32_t, 3> PrimitiveReader::read_corners(std::uint32_t triangle) const {
    const std::uint32_t i = triangle;
    switch (m_mode) {
    case TINYGLTF_MODE_TRIANGLE_STRIP: // glTF 2.0, section 3.7.2.1: every other triangle is turned
        return {read_vertex(i), read_vertex(i + 1 + i % 2), read_vertex(i + 2 - i % 2)};
    case TINYGLTF_MODE_TRIANGLE_FAN:
        return {read_vertex(i + 1), read_vertex(i + 2), read_vertex(0)};
    default:
        return {read_vertex(3 * i), read_vertex(3 * i + 1), read_vertex(3 * i + 2)};
    }
}

std::array<PrimitiveReader::Influence, 8> PrimitiveReader::read_influences(std::uint32_t vertex) const {
    std::array<Influence, 8> influences;
    for (std::uint32_t i = 0; i < influences.size(); ++i) {
        const AccessorColumn& joints = m_joints[i / 4];
        const AccessorColumn& weights = m_weights[i / 4];
        if (!joints.bytes || !weights.bytes)
            continue;
        const double weight = weights.read(vertex, i % 4);
        if (weight > 0 && std::isfinite(weight))
            influences[i] = {joints.read_unsigned(vertex, i % 4), weight};
    }
    return influences;
}

glm::dvec3 PrimitiveReader::read_morphed(const AccessorColumn& column, AccessorColumn Target::* moved,
                                         std::uint32_t vertex) const {
    glm::dvec3 vector = read_vector(column, vertex);
    for (const Target& target : m_targets)
        if ((target.*moved).bytes)
            vector += target.weight * read_vector(target.*moved, vertex);
    return vector;
}

glm::dvec4 PrimitiveReader::read_finite(const AccessorColumn& column, std::uint32_t vertex) {
    glm::dvec4 vector(0, 0, 0, 1);
    for (std::uint32_t part = 0; part < column.width; ++part) {
        const double value = column.read(vertex, part);
        vector[int(part)] = std::isfinite(value) ? value : 0.0;
    }
    return vector;
}

} // namespace photonloupe
