// SPDX-License-Identifier: Apache-2.0
// What load_scene makes of geometry: modes, transforms, normals, scales and offsets.
#include "scene/gltf_builder.h"

#include <bit>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/temporary_folder.h"

namespace photonloupe::test {
namespace {

std::uint32_t as_uint(float value) {
    return std::bit_cast<std::uint32_t>(value);
}

glm::vec3 compute_normal(const shared::Triangle& t) {
    const glm::vec3 v0(t.v0_object);
    return glm::normalize(glm::cross(glm::vec3(t.v1_material) - v0, glm::vec3(t.v2_source) - v0));
}

// The right triangle with normals +z under a node transform.
Scene load_transformed(const Json& node) {
    GltfBuilder builder;
    const std::size_t positions = builder.add_vectors(RIGHT_TRIANGLE);
    const std::size_t normals = builder.add_vectors({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
    builder.add_object({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}}, node);
    return load(builder);
}

void expect_near(glm::vec3 a, glm::vec3 b) {
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(a[axis], b[axis], 1e-6f) << "axis " << axis;
}

TEST(load_scene, a_triangle_keeps_its_corners_indices_and_bounds) {
    const Scene scene = load(make_triangle());
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(glm::vec3(scene.triangles[0].v1_material), glm::vec3(1, 0, 0));
    EXPECT_EQ(as_uint(scene.triangles[0].v0_object.w), 0u);
    EXPECT_EQ(as_uint(scene.triangles[0].v2_source.w), 0u);
    EXPECT_EQ(scene.bounds.hi, (std::array<double, 3>{1, 1, 0}));
    EXPECT_EQ(scene.objects.at(0).triangle_count, 1u);
    EXPECT_EQ(scene.nodes.size(), 1u);
    EXPECT_EQ(scene.hash.size(), 32u);
}

TEST(load_scene, an_empty_document_is_an_empty_scene) {
    const Scene scene = load_text(R"({"asset": {"version": "2.0"}})");
    EXPECT_TRUE(scene.triangles.empty());
    EXPECT_TRUE(scene.nodes.empty());
    EXPECT_EQ(scene.bounds.lo, (std::array<double, 3>{}));
}

TEST(load_scene, the_hash_follows_the_text_and_the_buffer) {
    GltfBuilder builder = make_triangle();
    const std::string hash = load(builder).hash;
    EXPECT_EQ(load(builder).hash, hash);
    const TemporaryFolder folder;
    Json document = builder.document;
    document["buffers"] = Json::array({{{"byteLength", builder.get_buffer().size()}, {"uri", "a.bin"}}});
    const auto path = folder.write("a.gltf", document.dump());
    folder.write("a.bin", builder.get_buffer());
    const std::string first = load_scene(path).hash;
    std::string changed = builder.get_buffer();
    changed[15] = char(changed[15] ^ 1);
    folder.write("a.bin", changed);
    EXPECT_NE(load_scene(path).hash, first);
}

TEST(load_scene, triangles_of_zero_area_are_dropped_and_noted_but_slivers_and_duplicates_stay) {
    GltfBuilder builder;
    builder.add_triangles({{0, 0, 0},
                           {1, 0, 0},
                           {0, 1, 0}, // kept
                           {0, 0, 0},
                           {1, 0, 0},
                           {0, 1, 0}, // a duplicate
                           {0, 0, 0},
                           {1, 0, 0},
                           {0.5f, 1e-6f, 0}, // a sliver
                           {0, 0, 0},
                           {1, 1, 1},
                           {2, 2, 2}, // a line
                           {3, 3, 3},
                           {3, 3, 3},
                           {3, 3, 3}, // a point
                           {0, 0, 0},
                           {1e-30f, 0, 0},
                           {0, 1e-30f, 0}}); // tiny
    const Scene scene = load(builder);
    EXPECT_EQ(scene.triangles.size(), 4u);
    EXPECT_EQ(scene.objects[0].triangle_count, 4u);
    EXPECT_TRUE(contains(scene.report.notes, "2 triangles of zero area were dropped"));
}

TEST(load_scene, strips_and_fans_turn_their_triangles_one_way) {
    for (const int mode : {5, 6}) {
        GltfBuilder builder;
        const Vectors strip{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}};
        const Vectors fan{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 2, 0}};
        const std::size_t positions = builder.add_vectors(mode == 5 ? strip : fan);
        const std::size_t indices = builder.add_indices<std::uint8_t>({0, 1, 2, 3, 4});
        builder.add_object({{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"mode", mode}});
        const Scene scene = load(builder);
        ASSERT_EQ(scene.triangles.size(), 3u);
        for (const shared::Triangle& triangle : scene.triangles)
            expect_near(compute_normal(triangle), {0, 0, 1});
    }
}

TEST(load_scene, indices_of_8_16_and_32_bits_read_the_same) {
    GltfBuilder builder;
    const Json attributes{{"POSITION", builder.add_vectors({{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}};
    builder.add_object({{"attributes", attributes}, {"indices", builder.add_indices<std::uint8_t>({1, 2, 3})}});
    builder.add_object({{"attributes", attributes}, {"indices", builder.add_indices<std::uint16_t>({1, 2, 3})}});
    builder.add_object({{"attributes", attributes}, {"indices", builder.add_indices<std::uint32_t>({1, 2, 3})}});
    const Scene scene = load(builder);
    ASSERT_EQ(scene.triangles.size(), 3u);
    for (const shared::Triangle& triangle : scene.triangles)
        EXPECT_EQ(glm::vec3(triangle.v1_material), glm::vec3(1, 0, 0));
}

TEST(load_scene, interleaved_vertices_are_read_by_their_stride) {
    GltfBuilder builder;
    builder.add_vectors({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 0, 1}});
    builder.document["bufferViews"][0]["byteStride"] = 24;
    builder.document["accessors"][0]["count"] = 3;
    builder.document["accessors"].push_back(builder.document["accessors"][0]);
    builder.document["accessors"][1]["byteOffset"] = 12;
    builder.add_object({{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}});
    const Scene scene = load(builder);
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(glm::vec3(scene.triangles[0].v2_source), glm::vec3(0, 1, 0));
    EXPECT_EQ(glm::vec3(scene.normals[0].n2), glm::vec3(0, 0, 1));
}

TEST(load_scene, translation_rotation_and_scale_are_applied_in_gltfs_order) {
    const double half = std::sqrt(0.5);
    const Scene scene =
        load_transformed({{"translation", {1, 2, 3}}, {"rotation", {0, 0, half, half}}, {"scale", {2, 3, 4}}});
    expect_near(glm::vec3(scene.triangles[0].v1_material), {1, 4, 3}); // x · 2, a quarter turn about z, moved
    expect_near(glm::vec3(scene.triangles[0].v2_source), {-2, 2, 3});
}

TEST(load_scene, a_matrix_is_read_by_columns) {
    const Scene scene = load_transformed({{"matrix", {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 1, 2, 3, 1}}});
    EXPECT_EQ(glm::vec3(scene.triangles[0].v1_material), glm::vec3(1, 4, 3));
    EXPECT_EQ(glm::vec3(scene.triangles[0].v2_source), glm::vec3(-2, 2, 3));
}

TEST(load_scene, children_move_with_their_parents) {
    GltfBuilder builder = make_triangle();
    builder.document["nodes"].push_back({{"children", {0}}, {"translation", {0, 0, 5}}, {"scale", {2, 2, 2}}});
    builder.document["nodes"][0]["translation"] = {1, 0, 0};
    EXPECT_EQ(glm::vec3(load(builder).triangles[0].v1_material), glm::vec3(4, 0, 5));
}

TEST(load_scene, mirrored_nodes_keep_geometric_and_shading_normals_on_one_side) {
    for (const Json& scale : {Json{-1, 1, 1}, Json{1, -1, 1}, Json{1, 1, -1}, Json{-1, -1, -1}, Json{-2, 3, 1}}) {
        const Scene scene = load_transformed({{"scale", scale}});
        ASSERT_EQ(scene.triangles.size(), 1u);
        const glm::vec3 normal(scene.normals[0].n1);
        EXPECT_GT(glm::dot(compute_normal(scene.triangles[0]), normal), 0.99f) << scale;
        EXPECT_EQ(normal.z, scale[2] < 0 ? -1.0f : 1.0f) << scale;
    }
}

TEST(load_scene, normals_go_through_the_inverse_transpose) {
    GltfBuilder builder;
    const std::size_t positions = builder.add_vectors({{0, 0, 0}, {1, 0, -1}, {0, 1, 0}}); // the plane x + z = 0
    const std::size_t normals = builder.add_vectors({{1, 0, 1}, {1, 0, 1}, {1, 0, 1}});
    builder.add_object({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}}, {{"scale", {3, 1, 1}}});
    const Scene scene = load(builder);
    expect_near(glm::vec3(scene.normals[0].n0), compute_normal(scene.triangles[0]));
}

TEST(load_scene, missing_normals_are_flat_and_noted) {
    const Scene scene = load(make_triangle());
    EXPECT_EQ(glm::vec3(scene.normals[0].n0), glm::vec3(0, 0, 1));
    EXPECT_TRUE(contains(scene.report.notes, "1 primitive has no normals"));
}

TEST(load_scene, shading_normals_are_unit_vectors_from_1e_30_to_1e30_and_beyond) {
    GltfBuilder builder;
    const std::size_t positions = builder.add_vectors(RIGHT_TRIANGLE);
    const std::size_t normals = builder.add_vectors({{3e-30f, 0, 4e-30f}, {3e30f, 0, 4e30f}, {3e-44f, 0, 4e-44f}});
    builder.add_object({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
    const Scene scene = load(builder);
    expect_near(glm::vec3(scene.normals[0].n0), {0.6f, 0, 0.8f});
    expect_near(glm::vec3(scene.normals[0].n1), {0.6f, 0, 0.8f});
    EXPECT_NEAR(glm::length(glm::vec3(scene.normals[0].n2)), 1.0f, 1e-6f);
}

TEST(load_scene, shading_normals_of_zero_length_become_geometric_and_turned_ones_stay) {
    GltfBuilder builder;
    const std::size_t positions = builder.add_vectors(RIGHT_TRIANGLE);
    const std::size_t normals = builder.add_vectors({{0, 0, 0}, {0, 0, -2}, {0, 0, 1}});
    builder.add_object({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
    const Scene scene = load(builder);
    EXPECT_EQ(glm::vec3(scene.normals[0].n0), glm::vec3(0, 0, 1));
    EXPECT_EQ(glm::vec3(scene.normals[0].n1), glm::vec3(0, 0, -1));
    EXPECT_TRUE(contains(scene.report.notes, "1 shading normal of zero length or not finite was replaced"));
    EXPECT_TRUE(contains(scene.report.notes, "1 triangle has a shading normal on its back side"));
}

TEST(load_scene, a_node_flattened_to_a_plane_keeps_finite_normals) {
    const Scene scene = load_transformed({{"scale", {1, 1, 0}}});
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(glm::vec3(scene.normals[0].n0), glm::vec3(0, 0, 1));
    EXPECT_TRUE(load_transformed({{"scale", {0, 1, 1}}}).triangles.empty());
}

// A few triangles in general position, scaled by the node or by their coordinates.
Scene load_scaled(double node_scale, float coordinate_scale) {
    GltfBuilder builder;
    Vectors corners;
    for (int i = 0; i < 60; ++i)
        corners.push_back({std::sin(1.1f * float(i)) * coordinate_scale, std::cos(2.3f * float(i)) * coordinate_scale,
                           (std::sin(3.7f * float(i)) + 20.0f) * coordinate_scale});
    builder.add_triangles(corners,
                          {{"scale", {node_scale, node_scale, node_scale}}, {"rotation", {0.1, 0.2, 0.3, 0.9}}});
    return load(builder);
}

TEST(load_scene, a_scene_scaled_by_a_power_of_two_has_the_same_bits_scaled) {
    const Scene scene = load_scaled(1.0, 1.0f);
    EXPECT_NE(scene.origin[2], 0.0); // 20 away from a cloud of radius about 1.7
    for (const int exponent : {-20, 20})
        for (const bool by_node : {true, false}) {
            const float scale = std::ldexp(1.0f, exponent);
            const Scene other = by_node ? load_scaled(scale, 1.0f) : load_scaled(1.0, scale);
            ASSERT_EQ(other.triangles.size(), scene.triangles.size());
            for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
                EXPECT_EQ(glm::vec3(other.triangles[i].v0_object), glm::vec3(scene.triangles[i].v0_object) * scale);
                EXPECT_EQ(glm::vec3(other.triangles[i].v2_source), glm::vec3(scene.triangles[i].v2_source) * scale);
                EXPECT_EQ(other.normals[i].n0, scene.normals[i].n0);
                EXPECT_EQ(as_uint(other.triangles[i].v2_source.w), as_uint(scene.triangles[i].v2_source.w));
            }
            EXPECT_EQ(other.origin[2], scene.origin[2] * scale);
        }
}

TEST(load_scene, scenes_of_a_micrometer_and_of_a_megameter_load_whole) {
    for (const float scale : {1e-6f, 1e6f})
        EXPECT_EQ(load_scaled(1.0, scale).triangles.size(), 20u);
}

TEST(load_scene, a_scene_a_thousand_kilometers_away_loses_no_digits) {
    const Scene near = load_transformed({{"scale", {0.001, 0.001, 0.001}}});
    const Scene far = load_transformed({{"scale", {0.001, 0.001, 0.001}}, {"translation", {1e6, -1e6, 1e6}}});
    const glm::vec3 near_edge = glm::vec3(near.triangles[0].v1_material) - glm::vec3(near.triangles[0].v0_object);
    const glm::vec3 far_edge = glm::vec3(far.triangles[0].v1_material) - glm::vec3(far.triangles[0].v0_object);
    EXPECT_NEAR(far_edge.x / near_edge.x, 1.0f, 1e-6f); // double keeps 1e-10 of a meter there
    EXPECT_NEAR(far.origin[0], 1e6 + 0.0005, 1e-9);
    EXPECT_EQ(far.bounds.lo[1], -1e6);
}

TEST(load_scene, a_scene_near_zero_keeps_its_origin) {
    EXPECT_EQ(load_transformed({{"translation", {4, 0, 0}}}).origin, (std::array<double, 3>{}));
}

TEST(load_scene, coordinates_beyond_the_range_of_floats_are_refused_by_object) {
    for (const double size : {1e31, 1e300})
        try {
            load_transformed({{"name", "huge"}, {"scale", {size, size, size}}});
            ADD_FAILURE() << size;
        } catch (const SceneError& error) {
            EXPECT_CONTAINS(error.what(), "object \"huge\" has coordinates beyond 1e30");
        }
    GltfBuilder builder = make_triangle();
    builder.document["nodes"] = Json::parse(R"([{"scale":[1e300,1,1],"children":[1]},{"mesh":0,"scale":[1e300,1,1]}])");
    EXPECT_CONTAINS(find_refusal(builder), "coordinates beyond 1e30");
}

TEST(load_scene, only_the_default_or_the_first_scenes_nodes_are_drawn) {
    GltfBuilder builder = make_triangle();
    builder.add_triangles({{0, 0, 5}, {1, 0, 5}, {0, 1, 5}});
    builder.document["scenes"] = Json::parse(R"([{"nodes":[0]},{"nodes":[1]}])");
    const Scene first = load(builder);
    EXPECT_EQ(first.bounds.hi[2], 0);
    EXPECT_TRUE(contains(first.report.ignored, "only the first scene 0 of 2 is read"));
    builder.document["scene"] = 1;
    const Scene scene = load(builder);
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(scene.triangles[0].v0_object.z, 5.0f);
}

} // namespace
} // namespace photonloupe::test
