// SPDX-License-Identifier: Apache-2.0
// Meshes: accessor kinds, equal lengths, indices in range, finite coordinates.
#include "scene/gltf_meshes.h"

#include <cmath>
#include <cstring>

#include <nlohmann/json.hpp>

#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr const char* REMEDY = "repair the file or export it again";

template <class Number>
Number read_bytes(const unsigned char* bytes) {
    Number number;
    std::memcpy(&number, bytes, sizeof number); // elements may be unaligned in memory
    return number;
}

// Looks at each accessor's bytes once, however many primitives share it.
class AccessorChecks {
public:
    AccessorChecks(const std::vector<AccessorSpan>& accessors, const BufferBytes& buffers)
        : m_accessors(accessors), m_buffers(buffers), m_largest_index(accessors.size()), m_is_finite(accessors.size()) {
    }

    const AccessorSpan& check_vectors(std::uint32_t index, const JsonPlace& use, const char* what) {
        const AccessorSpan& accessor = m_accessors[index];
        check_readable(accessor, use);
        if (accessor.type != "VEC3" || accessor.component_type != COMPONENT_FLOAT)
            refuse(accessor.place,
                   std::string(what) + " must be VEC3 of 32-bit floats, this is " + accessor.type + " of type " +
                       std::to_string(accessor.component_type),
                   "export it without KHR_mesh_quantization");
        if (!m_is_finite[index])
            check_finite(accessor, what);
        m_is_finite[index] = true;
        return accessor;
    }

    const AccessorSpan& check_indices(std::uint32_t index, std::uint64_t vertex_count, const JsonPlace& use) {
        const AccessorSpan& accessor = m_accessors[index];
        check_readable(accessor, use);
        const bool is_index_type = accessor.component_type == COMPONENT_UNSIGNED_BYTE ||
                                   accessor.component_type == COMPONENT_UNSIGNED_SHORT ||
                                   accessor.component_type == COMPONENT_UNSIGNED_INT;
        if (accessor.type != "SCALAR" || !is_index_type || accessor.is_normalized)
            refuse(accessor.place, "indices must be SCALAR of unsigned 8, 16 or 32 bits", REMEDY);
        if (!m_largest_index[index])
            m_largest_index[index] = find_largest_index(accessor);
        if (*m_largest_index[index] >= vertex_count)
            refuse(accessor.place,
                   "index " + std::to_string(*m_largest_index[index]) + " is used by " + use.path +
                       ", which has only " + std::to_string(vertex_count) + " vertices",
                   REMEDY);
        return accessor;
    }

private:
    void check_readable(const AccessorSpan& accessor, const JsonPlace& use) const {
        if (accessor.is_sparse)
            refuse(accessor.place, "sparse accessors are not supported (used by " + use.path + ")",
                   "export the geometry without them");
        if (!accessor.has_bytes)
            refuse(accessor.place, "it has no bufferView (used by " + use.path + ")", REMEDY);
    }

    const unsigned char* get_element_bytes(const AccessorSpan& accessor, std::uint64_t element) const {
        return m_buffers[accessor.buffer].data() + accessor.offset + element * accessor.stride;
    }

    void check_finite(const AccessorSpan& accessor, const char* what) const {
        for (std::uint64_t i = 0; i < accessor.count; ++i)
            for (int axis = 0; axis < 3; ++axis)
                if (!std::isfinite(read_bytes<float>(get_element_bytes(accessor, i) + axis * sizeof(float))))
                    refuse(accessor.place,
                           std::string(what) + " " + std::to_string(i) + " is not finite in component " +
                               std::to_string(axis),
                           "remove NaN and infinity from the mesh");
    }

    std::uint64_t find_largest_index(const AccessorSpan& accessor) const {
        std::uint64_t largest = 0;
        for (std::uint64_t i = 0; i < accessor.count; ++i) {
            const unsigned char* bytes = get_element_bytes(accessor, i);
            std::uint64_t value = 0;
            if (accessor.component_type == COMPONENT_UNSIGNED_BYTE)
                value = *bytes;
            else if (accessor.component_type == COMPONENT_UNSIGNED_SHORT)
                value = read_bytes<std::uint16_t>(bytes);
            else
                value = read_bytes<std::uint32_t>(bytes);
            largest = std::max(largest, value);
        }
        return largest;
    }

    const std::vector<AccessorSpan>& m_accessors;
    const BufferBytes& m_buffers;
    std::vector<std::optional<std::uint64_t>> m_largest_index;
    std::vector<bool> m_is_finite;
};

std::uint64_t count_triangles(std::uint64_t mode, std::uint64_t vertex_count, const JsonPlace& place) {
    if (vertex_count < 3)
        refuse(place, "it draws triangles from " + std::to_string(vertex_count) + " vertices", REMEDY);
    if (mode != MODE_TRIANGLES)
        return vertex_count - 2;
    if (vertex_count % 3 != 0)
        refuse(place, std::to_string(vertex_count) + " vertices make no whole number of triangles", REMEDY);
    return vertex_count / 3;
}

// Checks one primitive that draws triangles; returns their number.
std::uint64_t check_triangles(const JsonPlace& place, std::uint64_t mode, std::size_t accessor_count,
                              std::size_t material_count, AccessorChecks& checks, Json& approved) {
    const JsonPlace attributes = find_member(place, "attributes");
    const auto positions = *read_index(find_member(attributes, "POSITION"), accessor_count, "accessor");
    const std::uint64_t vertex_count = checks.check_vectors(positions, place, "POSITION").count;
    approved = {{"mode", mode}, {"attributes", {{"POSITION", positions}}}};
    if (const auto normals = read_index(find_member(attributes, "NORMAL"), accessor_count, "accessor")) {
        const std::uint64_t normal_count = checks.check_vectors(*normals, place, "NORMAL").count;
        if (normal_count != vertex_count)
            refuse(place, std::to_string(vertex_count) + " positions but " + std::to_string(normal_count) + " normals",
                   REMEDY);
        approved["attributes"]["NORMAL"] = *normals;
    }
    if (const auto material = read_index(find_member(place, "material"), material_count, "material"))
        approved["material"] = *material;
    std::uint64_t corner_count = vertex_count;
    if (const auto indices = read_index(find_member(place, "indices"), accessor_count, "accessor")) {
        corner_count = checks.check_indices(*indices, vertex_count, place).count;
        approved["indices"] = *indices;
    }
    return count_triangles(mode, corner_count, place);
}

} // namespace

std::vector<std::uint64_t> check_meshes(const JsonPlace& root, const std::vector<AccessorSpan>& accessors,
                                        const BufferBytes& buffers, Json& approved, std::vector<std::string>& ignored) {
    AccessorChecks checks(accessors, buffers);
    const std::size_t material_count = count_elements(find_member(root, "materials"), MAX_ENTRIES);
    const JsonPlace meshes = find_member(root, "meshes");
    const std::size_t mesh_count = count_elements(meshes, MAX_ENTRIES);
    std::vector<std::uint64_t> triangle_counts;
    for (std::size_t mesh = 0; mesh < mesh_count; ++mesh) {
        const JsonPlace place = get_element(meshes, mesh);
        const JsonPlace primitives = require_member(place, "primitives");
        const std::size_t primitive_count = count_elements(primitives, MAX_ENTRIES);
        Json approved_primitives = Json::array();
        std::uint64_t triangle_count = 0;
        for (std::size_t i = 0; i < primitive_count; ++i) {
            const JsonPlace primitive = get_element(primitives, i);
            const std::uint64_t mode =
                read_unsigned_or(find_member(primitive, "mode"), MODE_TRIANGLE_FAN, MODE_TRIANGLES);
            if (mode < MODE_TRIANGLES) {
                ignored.push_back(primitive.path + ": points and lines are not modeled");
            } else if (!find_member(require_member(primitive, "attributes"), "POSITION").value) {
                ignored.push_back(primitive.path + ": a primitive without POSITION draws nothing");
            } else {
                approved_primitives.emplace_back();
                triangle_count += check_triangles(primitive, mode, accessors.size(), material_count, checks,
                                                  approved_primitives.back());
            }
        }
        triangle_counts.push_back(triangle_count);
        approved["meshes"].push_back(
            {{"name", read_string_or(find_member(place, "name"), "")}, {"primitives", std::move(approved_primitives)}});
    }
    return triangle_counts;
}

} // namespace photonloupe
