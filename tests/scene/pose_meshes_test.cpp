// SPDX-License-Identifier: Apache-2.0
// Skins, morph targets and instances stand where a file's rest pose puts them.
#include "scene/gltf_builder.h"

#include <limits>

#include <glm/vec3.hpp>
#include <gtest/gtest.h>

namespace photonloupe::test {
namespace {

glm::vec3 find_corner(const Scene& scene, int corner) {
    const shared::Triangle& triangle = scene.triangles.at(0);
    return glm::vec3(corner == 0 ? triangle.v0_object : corner == 1 ? triangle.v1_material : triangle.v2_source);
}

// Morph targets

// The second corner moves by (0, 0, 1) and by (4, 0, 0), the normals by (1, 0, -1) with the first.
GltfBuilder make_morphed() {
    GltfBuilder builder;
    const Json attributes{{"POSITION", builder.add_vectors(RIGHT_TRIANGLE)},
                          {"NORMAL", builder.add_vectors({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}})}};
    const std::size_t up = builder.add_vectors({{0, 0, 0}, {0, 0, 1}, {0, 0, 0}});
    const std::size_t turned = builder.add_vectors({{1, 0, -1}, {1, 0, -1}, {1, 0, -1}});
    const std::size_t along = builder.add_vectors({{0, 0, 0}, {4, 0, 0}, {0, 0, 0}});
    builder.add_object(
        {{"attributes", attributes}, {"targets", {{{"POSITION", up}, {"NORMAL", turned}}, {{"POSITION", along}}}}});
    return builder;
}

TEST(pose_meshes, morph_targets_move_by_the_weights_of_the_mesh_or_of_the_node) {
    GltfBuilder builder = make_morphed();
    EXPECT_EQ(find_corner(load(builder), 1), glm::vec3(1, 0, 0));
    builder.document["meshes"][0]["weights"] = {1, 0.5};
    EXPECT_EQ(find_corner(load(builder), 1), glm::vec3(3, 0, 1));
    EXPECT_EQ(glm::vec3(load(builder).normals.at(0).n0), glm::vec3(1, 0, 0));
    builder.document["nodes"][0]["weights"] = {0, 1, 7}; // more than there are targets
    EXPECT_EQ(find_corner(load(builder), 1), glm::vec3(5, 0, 0));
}

TEST(pose_meshes, morph_targets_that_do_not_fit_are_refused) {
    GltfBuilder builder = make_morphed();
    Json& target = builder.document["meshes"][0]["primitives"][0]["targets"][0];
    target["POSITION"] = builder.add_vectors({{0, 0, 0}, {0, 0, 1}});
    EXPECT_CONTAINS(find_refusal(builder), "/meshes/0/primitives/0/targets/0: 3 positions but 2 of POSITION");
    target["POSITION"] = builder.add_vectors({{0, 0, 0}, {0, 0, 1}, {0, std::numeric_limits<float>::infinity(), 0}});
    EXPECT_CONTAINS(find_refusal(builder), "POSITION 2 is not finite in component 1");
    builder = make_morphed();
    builder.document["meshes"][0]["weights"] = {"1"};
    EXPECT_CONTAINS(find_refusal(builder), "/meshes/0/weights/0: a number was expected");
}

// Skins

// Two joints at (0, 0, 3) and (0, 0, 5), at rest at the origin; the mesh's own node is far away.
GltfBuilder make_skinned(const std::vector<std::uint8_t>& joints, const std::vector<std::uint8_t>& weights) {
    GltfBuilder builder;
    const Json attributes{{"POSITION", builder.add_vectors(RIGHT_TRIANGLE)},
                          {"JOINTS_0", builder.add_numbers(joints, 3, "VEC4", 5121)},
                          {"WEIGHTS_0", builder.add_numbers(weights, 3, "VEC4", 5121)}};
    std::vector<float> matrices(32, 0.0f);
    for (std::size_t i = 0; i < 2; ++i)
        matrices[16 * i] = matrices[16 * i + 5] = matrices[16 * i + 10] = matrices[16 * i + 15] = 1;
    matrices[30] = -1; // the second joint is bound one lower
    builder.document["skins"] = {
        {{"joints", {1, 2}}, {"inverseBindMatrices", builder.add_numbers(matrices, 2, "MAT4", 5126)}}};
    builder.add_object({{"attributes", attributes}}, {{"skin", 0}, {"translation", {1000, 0, 0}}});
    builder.document["nodes"].push_back({{"translation", {0, 0, 3}}, {"children", {2}}});
    builder.document["nodes"].push_back({{"translation", {0, 0, 2}}});
    return builder;
}

constexpr std::uint8_t ALL = 255;

TEST(pose_meshes, a_skin_moves_vertices_by_their_joints_and_not_by_their_node) {
    const Scene scene =
        load(make_skinned({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, {ALL, 0, 0, 0, ALL, 0, 0, 0, 60, 60, 0, 0}));
    EXPECT_EQ(find_corner(scene, 0), glm::vec3(0, 0, 3));
    EXPECT_EQ(find_corner(scene, 1), glm::vec3(1, 0, 4));    // 5 less what the joint was bound at
    EXPECT_EQ(find_corner(scene, 2), glm::vec3(0, 1, 3.5f)); // weights that do not sum to 1
}

TEST(pose_meshes, vertices_without_weights_follow_the_first_joint) {
    const Scene scene = load(make_skinned(std::vector<std::uint8_t>(12, 0), std::vector<std::uint8_t>(12, 0)));
    EXPECT_EQ(find_corner(scene, 1), glm::vec3(1, 0, 3));
}

TEST(pose_meshes, a_skin_that_mirrors_keeps_the_outside_outside) {
    GltfBuilder builder = make_skinned(std::vector<std::uint8_t>(12, 0), {ALL, 0, 0, 0, ALL, 0, 0, 0, ALL, 0, 0, 0});
    builder.document["nodes"][1]["scale"] = {-1, 1, 1};
    EXPECT_EQ(glm::vec3(load(builder).normals.at(0).n0), glm::vec3(0, 0, 1));
}

TEST(pose_meshes, joints_that_the_skin_lacks_are_refused_by_object_and_vertex) {
    const GltfBuilder builder =
        make_skinned({0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0}, {ALL, 0, 0, 0, ALL, 0, 0, 0, ALL, 0, 0, 0});
    EXPECT_CONTAINS(find_refusal(builder),
                    "object \"object 0\" has a vertex 1 that is moved by a joint its skin lacks");
}

TEST(pose_meshes, broken_skins_are_refused_where_a_node_uses_them) {
    const auto refuse_edit = [](const char* pointer, const Json& value) {
        GltfBuilder builder = make_skinned(std::vector<std::uint8_t>(12, 0), std::vector<std::uint8_t>(12, ALL));
        Json document = builder.finish();
        document[Json::json_pointer(pointer)] = value;
        return find_refusal(document);
    };
    EXPECT_EQ(refuse_edit("/skins/1", Json::object()), ""); // of no node
    EXPECT_CONTAINS(refuse_edit("/nodes/0/skin", 1), "there is no skin 1");
    EXPECT_CONTAINS(refuse_edit("/skins/0/joints", Json{1, 9}), "/skins/0/joints/1: there is no node 9");
    EXPECT_CONTAINS(refuse_edit("/skins/0/joints", Json{1, 2, 2}), "2 matrices for 3 joints");
    EXPECT_CONTAINS(refuse_edit("/skins/0/inverseBindMatrices", 0), "it must be MAT4 of floats");
    EXPECT_CONTAINS(refuse_edit("/accessors/1/componentType", 5120), "JOINTS_0 must be of unsigned integers");
}

// Instances

GltfBuilder make_instanced() {
    GltfBuilder builder;
    const std::size_t positions = builder.add_vectors(RIGHT_TRIANGLE);
    const std::size_t translations = builder.add_vectors({{0, 0, 1}, {0, 0, 2}});
    const std::size_t rotations =
        builder.add_numbers<std::int16_t>({0, 0, 0, 32767, 0, 0, 32767, 0}, 2, "VEC4", 5122); // none, half a turn
    builder.add_object(
        {{"attributes", {{"POSITION", positions}}}},
        {{"name", "tree"},
         {"scale", {2, 2, 2}},
         {"extensions",
          {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", translations}, {"ROTATION", rotations}}}}}}}});
    builder.document["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    return builder;
}

TEST(pose_meshes, instances_are_placed_within_their_node_and_numbered) {
    const Scene scene = load(make_instanced());
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(scene.bounds.lo, (std::array<double, 3>{-2, -2, 2}));
    EXPECT_EQ(scene.bounds.hi, (std::array<double, 3>{2, 2, 4}));
    EXPECT_EQ(scene.objects.at(1).name, "tree#1");
}

TEST(pose_meshes, instances_that_do_not_fit_are_refused_before_memory_is_taken) {
    GltfBuilder builder = make_instanced();
    builder.document["accessors"][2]["count"] = 1;
    EXPECT_CONTAINS(find_refusal(builder), "ROTATION: 1 instances, but 2 before");
    builder = make_instanced();
    builder.document["accessors"][1].erase("bufferView");
    builder.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"].erase("ROTATION");
    builder.document["accessors"][1]["count"] = 2147483647;
    EXPECT_CONTAINS(find_refusal(builder), "draws more than 33554432 triangles");
    builder.document["accessors"][1]["count"] = 1048577;
    EXPECT_CONTAINS(find_refusal(builder), "draws more than 1048576 objects");
}

} // namespace
} // namespace photonloupe::test
