// SPDX-License-Identifier: Apache-2.0
// Corners of triangles, strips and fans, indexed or not.
#include "scene/primitive_reader.h"

#include <cstring>

namespace photonloupe {

PrimitiveReader::PrimitiveReader(const tinygltf::Model& model, const tinygltf::Primitive& primitive)
    : m_positions(find_column(model, primitive.attributes.at("POSITION"))), m_mode(primitive.mode) {
    if (const auto normals = primitive.attributes.find("NORMAL"); normals != primitive.attributes.end())
        m_normals = find_column(model, normals->second);
    if (primitive.indices >= 0)
        m_indices = find_column(model, primitive.indices);
    const auto corner_count = std::uint32_t(m_indices ? m_indices->count : m_positions.count);
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

PrimitiveReader::Column PrimitiveReader::find_column(const tinygltf::Model& model, int accessor_index) {
    const tinygltf::Accessor& accessor = model.accessors.at(std::size_t(accessor_index));
    const tinygltf::BufferView& view = model.bufferViews.at(std::size_t(accessor.bufferView));
    const tinygltf::Buffer& buffer = model.buffers.at(std::size_t(view.buffer));
    return {buffer.data.data() + view.byteOffset + accessor.byteOffset, std::size_t(accessor.ByteStride(view)),
            accessor.componentType, accessor.count};
}

glm::dvec3 PrimitiveReader::read_vector(const Column& column, std::uint32_t element) {
    std::array<float, 3> v;
    std::memcpy(v.data(), column.bytes + element * column.stride, sizeof v);
    return {v[0], v[1], v[2]};
}

std::uint32_t PrimitiveReader::read_vertex(std::uint32_t corner) const {
    if (!m_indices)
        return corner;
    const unsigned char* bytes = m_indices->bytes + corner * m_indices->stride;
    if (m_indices->component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE)
        return *bytes;
    if (m_indices->component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) {
        std::uint16_t index;
        std::memcpy(&index, bytes, sizeof index);
        return index;
    }
    std::uint32_t index;
    std::memcpy(&index, bytes, sizeof index);
    return index;
}

} // namespace photonloupe
