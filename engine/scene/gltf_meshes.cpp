// SPDX-License-Identifier: Apache-2.0
// Meshes: accessor kinds, equal lengths, indices in range, finite positions.
#include "scene/gltf_meshes.h"

#include <array>
#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

#include "scene/gltf_draco.h"
#include "scene/gltf_skins.h"
#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr const char* REMEDY = "repair the file or export it again";

// What vertices may have beside their position. Integers of 8 and 16 bits are KHR_mesh_quantization's.
struct Attribute {
    const char* name;
    std::uint32_t fewest_components;
    std::uint32_t most_components;
};
constexpr std::array<Attribute, 8> OPTIONAL_ATTRIBUTES{{{"NORMAL", 3, 3},
                                                        {"TEXCOORD_0", 2, 2},
                                                        {"TEXCOORD_1", 2, 2},
                                                        {"COLOR_0", 3, 4},
                                                        {"JOINTS_0", 4, 4},
                                                        {"WEIGHTS_0", 4, 4},
                                                        {"JOINTS_1", 4, 4},
                                                        {"WEIGHTS_1", 4, 4}}};
// What morph targets move.
constexpr std::array<Attribute, 2> MORPHED_ATTRIBUTES{{{"POSITION", 3, 3}, {"NORMAL", 3, 3}}};
constexpr Attribute POSITION{"POSITION", 3, 3};

// Looks at each accessor's bytes once, however many primitives share it.
class AccessorChecks {
public:
    AccessorChecks(AccessorTable& accessors, std::vector<std::string>& ignored)
        : m_accessors(accessors), m_ignored(ignored), m_largest_index(accessors.get_count()),
          m_is_finite(accessors.get_count()) {}

    std::uint64_t check_vectors(std::uint32_t index, const Attribute& attribute) {
        const AccessorColumn& column = m_accessors.use(index);
        const JsonPlace place = m_accessors.get_place(index);
        if (column.width < attribute.fewest_components || column.width > attribute.most_components ||
            column.component_type == COMPONENT_UNSIGNED_INT)
            refuse(place,
                   std::string(attribute.name) + " must be VEC" + std::to_string(attribute.most_components) +
                       " of floats or of integers of 8 or 16 bits, this is " + read_string(find_member(place, "type")) +
                       " of type " + std::to_string(column.component_type),
                   REMEDY);
        if (std::string_view(attribute.name).starts_with("JOINTS") && !column.is_unsigned())
            refuse(place, std::string(attribute.name) + " must be of unsigned integers", REMEDY);
        if (!m_is_finite[index])
            check_finite(column, place, attribute);
        m_is_finite[index] = true;
        return column.count;
    }

    // Returns the number of indices.
    std::uint64_t check_indices(std::uint32_t index, std::uint64_t vertex_count, const JsonPlace& use) {
        const AccessorColumn& column = m_accessors.use(index);
        const JsonPlace place = m_accessors.get_place(index);
        if (column.width != 1 || !column.is_unsigned() || column.is_normalized)
            refuse(place, "indices must be SCALAR of unsigned 8, 16 or 32 bits", REMEDY);
        if (!m_largest_index[index])
            m_largest_index[index] = find_largest_index(column);
        if (*m_largest_index[index] >= vertex_count)
            refuse(place,
                   "index " + std::to_string(*m_largest_index[index]) + " is used by " + use.path +
                       ", which has only " + std::to_string(vertex_count) + " vertices",
                   REMEDY);
        return column.count;
    }

private:
    // Positions must be finite; normals are replaced where they are read, and counted there.
    void check_finite(const AccessorColumn& column, const JsonPlace& place, const Attribute& attribute) {
        std::uint64_t count = 0;
        for (std::uint64_t i = 0; column.component_type == COMPONENT_FLOAT && i < column.count; ++i)
            for (std::uint32_t part = 0; part < column.width; ++part) {
                if (std::isfinite(column.read(i, part)))
                    continue;
                ++count;
                if (std::string_view(attribute.name) == POSITION.name)
                    refuse(place,
                           "POSITION " + std::to_string(i) + " is not finite in component " + std::to_string(part),
                           "remove NaN and infinity from the mesh");
            }
        if (count > 0 && std::string_view(attribute.name) != "NORMAL")
            m_ignored.push_back(place.path + ": numbers that are not finite (" + std::to_string(count) + ") are 0");
    }

    static std::uint64_t find_largest_index(const AccessorColumn& column) {
        std::uint64_t largest = 0;
        for (std::uint64_t i = 0; i < column.count; ++i)
            largest = std::max<std::uint64_t>(largest, column.read_unsigned(i));
        return largest;
    }

    AccessorTable& m_accessors;
    std::vector<std::string>& m_ignored;
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

// Writes those attributes that are there and may be read.
template <std::size_t Count>
void check_attributes(const JsonPlace& attributes, const std::array<Attribute, Count>& known,
                      std::uint64_t vertex_count, std::size_t accessor_count, AccessorChecks& checks, Json& approved) {
    for (const Attribute& attribute : known) {
        const auto index = read_index(find_member(attributes, attribute.name), accessor_count, "accessor");
        if (!index)
            continue;
        const std::uint64_t count = checks.check_vectors(*index, attribute);
        if (count != vertex_count)
            refuse(attributes,
                   std::to_string(vertex_count) + " positions but " + std::to_string(count) + " of " + attribute.name,
                   REMEDY);
        approved[attribute.name] = *index;
    }
}

// Checks one primitive that draws triangles; returns their number.
std::uint64_t check_triangles(const JsonPlace& place, std::uint64_t mode, std::size_t material_count,
                              AccessorTable& accessors, AccessorChecks& checks, Json& approved) {
    if (decode_draco(place, accessors))
        mode = MODE_TRIANGLES;
    const JsonPlace attributes = find_member(place, "attributes");
    const auto positions = *read_index(find_member(attributes, POSITION.name), accessors.get_count(), "accessor");
    const std::uint64_t vertex_count = checks.check_vectors(positions, POSITION);
    approved = {{"mode", mode}, {"attributes", {{POSITION.name, positions}}}};
    check_attributes(attributes, OPTIONAL_ATTRIBUTES, vertex_count, accessors.get_count(), checks,
                     approved["attributes"]);
    const JsonPlace targets = find_member(place, "targets");
    for (std::size_t i = 0; i < count_elements(targets, MAX_MORPH_TARGETS); ++i) {
        Json target = Json::object();
        check_attributes(get_element(targets, i), MORPHED_ATTRIBUTES, vertex_count, accessors.get_count(), checks,
                         target);
        approved["targets"].push_back(std::move(target));
    }
    if (const auto material = read_index(find_member(place, "material"), material_count, "material"))
        approved["material"] = *material;
    std::uint64_t corner_count = vertex_count;
    if (const auto indices = read_index(find_member(place, "indices"), accessors.get_count(), "accessor")) {
        corner_count = checks.check_indices(*indices, vertex_count, place);
        approved["attributes"][INDICES] = *indices;
    }
    return count_triangles(mode, corner_count, place);
}

// Checks the primitives of a mesh that is drawn; returns the number of triangles.
std::uint64_t check_primitives(const JsonPlace& primitives, std::size_t material_count, AccessorTable& accessors,
                               AccessorChecks& checks, Json& approved, std::vector<std::string>& ignored) {
    std::uint64_t triangle_count = 0;
    for (std::size_t i = 0; i < count_elements(primitives, MAX_ENTRIES); ++i) {
        const JsonPlace primitive = get_element(primitives, i);
        const std::uint64_t mode = read_unsigned_or(find_member(primitive, "mode"), MODE_TRIANGLE_FAN, MODE_TRIANGLES);
        if (mode < MODE_TRIANGLES) {
            ignored.push_back(primitive.path + ": points and lines are not modeled");
        } else if (!find_member(require_member(primitive, "attributes"), POSITION.name).value) {
            ignored.push_back(primitive.path + ": a primitive without POSITION draws nothing");
        } else {
            approved.emplace_back();
            triangle_count += check_triangles(primitive, mode, material_count, accessors, checks, approved.back());
        }
    }
    return triangle_count;
}

} // namespace

void check_meshes(const JsonPlace& root, const std::vector<std::uint64_t>& draw_counts, AccessorTable& accessors,
                  Json& approved, std::vector<std::string>& ignored) {
    AccessorChecks checks(accessors, ignored);
    const std::size_t material_count = count_elements(find_member(root, "materials"), MAX_ENTRIES);
    const JsonPlace meshes = find_member(root, "meshes");
    std::uint64_t total = 0, object_count = 0, draw_count = 0;
    for (std::size_t mesh = 0; mesh < draw_counts.size(); ++mesh) {
        const JsonPlace place = get_element(meshes, mesh);
        const JsonPlace primitives = require_member(place, "primitives");
        Json entry{{"name", read_string_or(find_member(place, "name"), "")}, {"primitives", Json::array()}};
        if (draw_counts[mesh] > 0) {
            const std::uint64_t count =
                check_primitives(primitives, material_count, accessors, checks, entry["primitives"], ignored);
            if (count > 0 && draw_counts[mesh] > (MAX_TRIANGLES - total) / count)
                refuse(meshes, "the scene draws more than " + std::to_string(MAX_TRIANGLES) + " triangles",
                       "simplify the meshes or draw fewer instances");
            total += count * draw_counts[mesh];
            const std::uint64_t primitive_count = entry["primitives"].size();
            draw_count += std::min<std::uint64_t>(draw_counts[mesh], MAX_OBJECTS + 1); // of what draws nothing too
            object_count += primitive_count * std::min<std::uint64_t>(draw_counts[mesh], MAX_OBJECTS + 1);
            if (object_count > MAX_OBJECTS || draw_count > MAX_OBJECTS)
                refuse(meshes, "the scene draws more than " + std::to_string(MAX_OBJECTS) + " objects",
                       "join meshes or draw fewer instances");
            if (const JsonPlace weights = find_member(place, "weights"); weights.value)
                entry["weights"] = read_weights(weights);
        }
        approved["meshes"].push_back(std::move(entry));
    }
    accessors.list_broken(ignored);
}

} // namespace photonloupe
