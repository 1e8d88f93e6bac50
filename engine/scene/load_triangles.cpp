// SPDX-License-Identifier: Apache-2.0
// Two passes over all primitives: bounds and origin first, then the triangles, rounded to float once.
#include "scene/load_triangles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "scene/limits.h"
#include "scene/pose_meshes.h"
#include "scene/triangle_math.h"

namespace photonloupe {
namespace {

// Farther from the world's zero than this many half diagonals, the origin moves to the scene's center: 2^3, so that
// at most three of a float's 24 bits go to the offset.
constexpr double MAX_OFFSET_IN_HALF_DIAGONALS = 8.0;

struct PlacedPrimitive {
    PrimitiveReader reader;
    glm::dmat4 world;
    NormalTransform normals;               // of `world`
    const std::vector<glm::dmat4>* joints; // in place of `world`, or nothing
    std::uint32_t object;
};

struct Counts {
    std::size_t zero_area = 0;
    std::size_t flat_primitives = 0;
    std::size_t replaced_normals = 0;
    std::size_t turned_normals = 0;
    std::size_t without_material = 0;
    std::size_t far_coordinates = 0;
};

glm::dvec3 transform_point(const glm::dmat4& world, const glm::dvec3& point) {
    return glm::dvec3(world * glm::dvec4(point, 1.0));
}

std::vector<PlacedPrimitive> place_primitives(const tinygltf::Model& model, const std::vector<AccessorColumn>& columns,
                                              const std::vector<PlacedNode>& nodes,
                                              const std::vector<std::vector<glm::dmat4>>& skins, Scene& scene,
                                              Counts& counts) {
    std::vector<PlacedPrimitive> placed;
    const auto place = [&](const PlacedNode& node, const glm::dmat4& world, const std::string& suffix) {
        const tinygltf::Node& source = model.nodes[node.node];
        const tinygltf::Mesh& mesh = model.meshes[std::size_t(source.mesh)];
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            const tinygltf::Primitive& primitive = mesh.primitives[i];
            SceneObject object;
            object.name = name_node(model, node.node, mesh.name, "object") + suffix;
            if (mesh.primitives.size() > 1)
                object.name.append("[").append(std::to_string(i)).append("]");
            object.material =
                std::uint32_t(primitive.material < 0 ? model.materials.size() : std::size_t(primitive.material));
            const PrimitiveReader reader(primitive, columns, source.weights.empty() ? mesh.weights : source.weights);
            const bool is_skinned = source.skin >= 0 && reader.has_joints();
            placed.push_back({reader, world, NormalTransform(glm::dmat3(world)),
                              is_skinned ? &skins[std::size_t(source.skin)] : nullptr,
                              std::uint32_t(scene.objects.size())});
            scene.objects.push_back(std::move(object));
            counts.without_material += primitive.material < 0;
            counts.flat_primitives += !reader.has_normals();
        }
    };
    for (const PlacedNode& node : nodes) {
        if (model.nodes[node.node].mesh < 0)
            continue;
        const std::vector<glm::dmat4> instances = place_instances(model.nodes[node.node], node.world, columns);
        for (std::size_t i = 0; i < instances.size(); ++i)
            place(node, instances[i], instances.size() > 1 ? "#" + std::to_string(i) : "");
    }
    return placed;
}

[[noreturn]] void refuse_object(const Scene& scene, const PlacedPrimitive& primitive, const std::string& what) {
    throw SceneError(scene.path.string() + ": object \"" + scene.objects[primitive.object].name + "\" " + what);
}

[[noreturn]] void refuse_coordinates(const Scene& scene, const PlacedPrimitive& primitive) {
    refuse_object(scene, primitive,
                  "has coordinates beyond 1e30, which 32-bit floats can't compute with; scale the scene down");
}

glm::dmat4 find_transform(const PlacedPrimitive& primitive, std::uint32_t vertex, const Scene& scene) {
    if (!primitive.joints)
        return primitive.world;
    const std::optional<glm::dmat4> blended = blend_joints(*primitive.joints, primitive.reader, vertex);
    if (!blended)
        refuse_object(scene, primitive,
                      "has a vertex " + std::to_string(vertex) +
                          " that is moved by a joint its skin lacks; export it again");
    return *blended;
}

NormalTransform find_normal_transform(const PlacedPrimitive& primitive, std::uint32_t vertex, const Scene& scene) {
    return primitive.joints ? NormalTransform(glm::dmat3(find_transform(primitive, vertex, scene))) : primitive.normals;
}

glm::dvec3 find_position(const PlacedPrimitive& primitive, std::uint32_t vertex, const Scene& scene) {
    return transform_point(find_transform(primitive, vertex, scene), primitive.reader.read_position(vertex));
}

Bounds find_bounds(const std::vector<PlacedPrimitive>& primitives, const Scene& scene) {
    constexpr double INFINITE = std::numeric_limits<double>::infinity();
    Bounds bounds{{INFINITE, INFINITE, INFINITE}, {-INFINITE, -INFINITE, -INFINITE}};
    for (const PlacedPrimitive& primitive : primitives)
        for (std::uint32_t i = 0; i < primitive.reader.get_triangle_count(); ++i)
            for (const std::uint32_t vertex : primitive.reader.read_corners(i)) {
                const glm::dvec3 p = find_position(primitive, vertex, scene);
                for (int axis = 0; axis < 3; ++axis) {
                    if (!std::isfinite(p[axis]))
                        refuse_coordinates(scene, primitive);
                    bounds.lo[std::size_t(axis)] = std::min(bounds.lo[std::size_t(axis)], p[axis]);
                    bounds.hi[std::size_t(axis)] = std::max(bounds.hi[std::size_t(axis)], p[axis]);
                }
            }
    return bounds.lo[0] <= bounds.hi[0] ? bounds : Bounds{};
}

std::array<double, 3> choose_origin(const Bounds& bounds) {
    std::array<double, 3> center{};
    double distance_squared = 0.0, half_diagonal_squared = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        center[axis] = bounds.lo[axis] / 2 + bounds.hi[axis] / 2;
        const double half = bounds.hi[axis] / 2 - bounds.lo[axis] / 2;
        distance_squared += center[axis] * center[axis];
        half_diagonal_squared += half * half;
    }
    constexpr double LIMIT = MAX_OFFSET_IN_HALF_DIAGONALS * MAX_OFFSET_IN_HALF_DIAGONALS;
    return distance_squared > LIMIT * half_diagonal_squared ? center : std::array<double, 3>{};
}

class TriangleWriter {
public:
    TriangleWriter(Scene& scene, Counts& counts, bool has_colors)
        : m_scene(scene), m_counts(counts), m_has_colors(has_colors) {}

    void write_primitive(const PlacedPrimitive& primitive) {
        for (std::uint32_t i = 0; i < primitive.reader.get_triangle_count(); ++i) {
            std::array<std::uint32_t, 3> corners = primitive.reader.read_corners(i);
            // The outside stays outside when a node or its first corner's joints mirror.
            if (find_normal_transform(primitive, corners[0], m_scene).is_mirrored())
                std::swap(corners[1], corners[2]);
            write_triangle(primitive, corners, i);
        }
    }

private:
    void write_triangle(const PlacedPrimitive& primitive, const std::array<std::uint32_t, 3>& corners,
                        std::uint32_t source) {
        std::array<glm::vec3, 3> v;
        for (int i = 0; i < 3; ++i)
            v[std::size_t(i)] = round_position(primitive, corners[std::size_t(i)]);
        const glm::dvec3 area = compute_area_vector(v[0], v[1], v[2]);
        const std::optional<glm::dvec3> geometric = normalize_robustly(area);
        if (!geometric) {
            ++m_counts.zero_area;
            return;
        }
        SceneObject& object = m_scene.objects[primitive.object];
        ++object.triangle_count;
        m_scene.triangles.push_back({{v[0], std::bit_cast<float>(primitive.object)},
                                     {v[1], std::bit_cast<float>(object.material)},
                                     {v[2], std::bit_cast<float>(source)}});
        write_normals(primitive, corners, *geometric);
        if (!m_scene.textures.empty())
            write_coordinates(primitive.reader, corners);
        if (m_has_colors)
            write_colors(primitive.reader, corners);
    }

    glm::vec3 round_position(const PlacedPrimitive& primitive, std::uint32_t vertex) const {
        const glm::dvec3 p = find_position(primitive, vertex, m_scene);
        glm::vec3 rounded;
        for (int axis = 0; axis < 3; ++axis) {
            const double relative = p[axis] - m_scene.origin[std::size_t(axis)];
            if (!(std::abs(relative) <= MAX_COORDINATE))
                refuse_coordinates(m_scene, primitive);
            rounded[axis] = float(relative);
        }
        return rounded;
    }

    void write_normals(const PlacedPrimitive& primitive, const std::array<std::uint32_t, 3>& corners,
                       const glm::dvec3& geometric) {
        std::array<glm::dvec3, 3> normals{geometric, geometric, geometric};
        bool is_turned = false;
        for (std::size_t i = 0; i < 3 && primitive.reader.has_normals(); ++i) {
            const NormalTransform transform = find_normal_transform(primitive, corners[i], m_scene);
            const auto normal = normalize_robustly(transform.apply(primitive.reader.read_normal(corners[i])));
            m_counts.replaced_normals += !normal;
            normals[i] = normal.value_or(geometric);
            is_turned |= glm::dot(normals[i], geometric) < 0;
        }
        m_counts.turned_normals += is_turned;
        m_scene.normals.push_back(
            {{glm::vec3(normals[0]), 0.0f}, {glm::vec3(normals[1]), 0.0f}, {glm::vec3(normals[2]), 0.0f}});
    }

    void write_coordinates(const PrimitiveReader& reader, const std::array<std::uint32_t, 3>& corners) {
        std::array<glm::vec4, 3> coordinates{};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t set = 0; set < 2; ++set)
                if (reader.has_texcoords(set)) {
                    const glm::dvec2 uv = reader.read_texcoord(set, corners[i]);
                    for (int axis = 0; axis < 2; ++axis) {
                        const bool is_far = !(std::abs(uv[axis]) <= MAX_TEXTURE_COORDINATE);
                        m_counts.far_coordinates += is_far;
                        coordinates[i][int(2 * set) + axis] = is_far ? 0.0f : float(uv[axis]);
                    }
                }
        m_scene.corner_coordinates.push_back({coordinates[0], coordinates[1], coordinates[2]});
    }

    void write_colors(const PrimitiveReader& reader, const std::array<std::uint32_t, 3>& corners) {
        std::array<glm::vec4, 3> colors{glm::vec4(1.0f), glm::vec4(1.0f), glm::vec4(1.0f)};
        for (std::size_t i = 0; i < 3 && reader.has_colors(); ++i)
            colors[i] = glm::vec4(glm::clamp(reader.read_color(corners[i]), 0.0, 1.0));
        m_scene.corner_colors.push_back({colors[0], colors[1], colors[2]});
    }

    Scene& m_scene;
    Counts& m_counts;
    bool m_has_colors;
};

bool has_colors(const std::vector<PlacedPrimitive>& primitives) {
    return std::any_of(primitives.begin(), primitives.end(),
                       [](const PlacedPrimitive& primitive) { return primitive.reader.has_colors(); });
}

// Colors that change nothing would only cost time.
void drop_white(std::vector<shared::CornerColors>& colors) {
    const glm::vec4 white(1.0f);
    if (std::all_of(colors.begin(), colors.end(),
                    [&](const shared::CornerColors& c) { return c.c0 == white && c.c1 == white && c.c2 == white; }))
        colors = {};
}

void note(std::vector<std::string>& notes, std::size_t count, const std::string& singular, const std::string& plural) {
    if (count == 1)
        notes.push_back("1 " + singular);
    else if (count > 1)
        notes.push_back(std::to_string(count) + " " + plural);
}

void note_counts(const Counts& counts, std::vector<std::string>& notes) {
    note(notes, counts.zero_area, "triangle of zero area was dropped", "triangles of zero area were dropped");
    note(notes, counts.flat_primitives, "primitive has no normals and is shaded flat",
         "primitives have no normals and are shaded flat");
    note(notes, counts.replaced_normals,
         "shading normal of zero length or not finite was replaced by the geometric normal",
         "shading normals of zero length or not finite were replaced by the geometric normal");
    note(notes, counts.turned_normals, "triangle has a shading normal on its back side, which was kept",
         "triangles have a shading normal on their back side, which was kept");
    note(notes, counts.far_coordinates, "texture coordinate is beyond 10^6 and reads as 0",
         "texture coordinates are beyond 10^6 and read as 0");
    note(notes, counts.without_material,
         "primitive has no material; glTF's default, white metal, makes it rough and reflecting",
         "primitives have no material; glTF's default, white metal, makes them rough and reflecting");
}

} // namespace

void load_triangles(const tinygltf::Model& model, const std::vector<AccessorColumn>& columns,
                    const std::vector<PlacedNode>& nodes, Scene& scene) {
    Counts counts;
    const std::vector<std::vector<glm::dmat4>> skins = pose_joints(model, columns);
    const std::vector<PlacedPrimitive> primitives = place_primitives(model, columns, nodes, skins, scene, counts);
    scene.bounds = find_bounds(primitives, scene);
    scene.origin = choose_origin(scene.bounds);
    std::size_t triangle_count = 0;
    for (const PlacedPrimitive& primitive : primitives)
        triangle_count += primitive.reader.get_triangle_count();
    scene.triangles.reserve(triangle_count);
    scene.normals.reserve(triangle_count);
    TriangleWriter writer(scene, counts, has_colors(primitives));
    for (const PlacedPrimitive& primitive : primitives)
        writer.write_primitive(primitive);
    drop_white(scene.corner_colors);
    note_counts(counts, scene.report.notes);
}

} // namespace photonloupe
