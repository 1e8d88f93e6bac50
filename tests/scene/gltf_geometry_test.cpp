// SPDX-License-Identifier: Apache-2.0
// Refusals of buffers, views, accessors and primitives that do not fit together.
#include "scene/gltf_builder.h"

#include <limits>

#include <gtest/gtest.h>

namespace photonloupe::test {
namespace {

// The refusal after one edit of a triangle's document (with indices, accessor 1).
std::string refuse_edit(const char* pointer, const Json& value) {
    GltfBuilder builder;
    const std::size_t positions = builder.add_vectors(RIGHT_TRIANGLE);
    const std::size_t indices = builder.add_indices<std::uint16_t>({0, 1, 2});
    builder.add_object({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    Json document = builder.finish();
    document[Json::json_pointer(pointer)] = value;
    return find_refusal(document);
}

TEST(gltf_geometry, a_view_beyond_its_buffer_is_refused) {
    EXPECT_CONTAINS(refuse_edit("/bufferViews/0/byteOffset", 7), "/bufferViews/0: it ends at byte 43 of buffer 0");
    EXPECT_CONTAINS(refuse_edit("/bufferViews/0/buffer", 1), "there is no buffer 1");
    EXPECT_CONTAINS(refuse_edit("/bufferViews/0/byteLength", 0), "byteLength is 0");
}

TEST(gltf_geometry, offsets_that_would_overflow_are_refused) {
    const std::uint64_t huge = std::numeric_limits<std::uint64_t>::max() - 3;
    for (const char* pointer : {"/bufferViews/0/byteOffset", "/bufferViews/0/byteLength", "/accessors/0/byteOffset",
                                "/accessors/0/count", "/buffers/0/byteLength"})
        EXPECT_CONTAINS(refuse_edit(pointer, huge), "18446744073709551612 is more than");
    EXPECT_CONTAINS(refuse_edit("/accessors/0/count", 2147483647), "of a buffer view of 36");
}

TEST(gltf_geometry, negative_and_fractional_numbers_are_refused_but_whole_floats_are_not) {
    EXPECT_CONTAINS(refuse_edit("/bufferViews/0/byteOffset", -4), "a whole number of 0 or more was expected");
    EXPECT_CONTAINS(refuse_edit("/accessors/0/count", 2.5), "a whole number");
    EXPECT_CONTAINS(refuse_edit("/accessors/0/count", "3"), "a whole number");
    EXPECT_EQ(refuse_edit("/accessors/0/count", 3.0), "");
}

TEST(gltf_geometry, an_accessor_beyond_its_view_is_refused) {
    EXPECT_CONTAINS(refuse_edit("/accessors/0/count", 4), "/accessors/0: its 4 elements end at byte 48");
    EXPECT_CONTAINS(refuse_edit("/accessors/0/byteOffset", 4), "end at byte 40");
    EXPECT_CONTAINS(refuse_edit("/bufferViews/0/byteStride", 16), "end at byte 44");
    EXPECT_CONTAINS(refuse_edit("/accessors/0/count", 0), "count is 0");
}

TEST(gltf_geometry, strides_shorter_than_an_element_are_refused) {
    EXPECT_CONTAINS(refuse_edit("/bufferViews/0/byteStride", 8), "shorter than an element");
}

TEST(gltf_geometry, unknown_component_types_and_element_types_are_refused) {
    EXPECT_CONTAINS(refuse_edit("/accessors/0/componentType", 5124), "component type 5124 is none of glTF 2.0");
    EXPECT_CONTAINS(refuse_edit("/accessors/0/type", "VEC5"), "type \"VEC5\"");
}

TEST(gltf_geometry, attributes_of_other_kinds_are_refused) {
    EXPECT_CONTAINS(refuse_edit("/accessors/0/componentType", 5125),
                    "/accessors/0: POSITION must be VEC3 of floats or of integers of 8 or 16 bits");
    EXPECT_CONTAINS(refuse_edit("/accessors/0/type", "VEC2"), "this is VEC2 of type 5126");
}

TEST(gltf_geometry, an_index_beyond_the_vertices_is_refused) {
    GltfBuilder builder;
    const std::size_t positions = builder.add_vectors(RIGHT_TRIANGLE);
    const std::size_t indices = builder.add_indices<std::uint32_t>({0, 1, 3});
    builder.add_object({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    EXPECT_CONTAINS(find_refusal(builder), "/accessors/1: index 3 is used by /meshes/0/primitives/0, which has only 3");
}

TEST(gltf_geometry, the_primitive_restart_index_is_refused) {
    GltfBuilder builder;
    const std::size_t positions = builder.add_vectors(RIGHT_TRIANGLE);
    const std::size_t indices = builder.add_indices<std::uint8_t>({0, 1, 255});
    builder.add_object({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    EXPECT_CONTAINS(find_refusal(builder), "index 255");
}

TEST(gltf_geometry, float_indices_are_refused) {
    EXPECT_CONTAINS(refuse_edit("/meshes/0/primitives/0/indices", 0), "indices must be SCALAR");
}

TEST(gltf_geometry, coordinates_that_are_not_finite_are_refused_by_accessor) {
    GltfBuilder builder;
    builder.add_triangles({{0, 0, 0}, {1, std::numeric_limits<float>::quiet_NaN(), 0}, {0, 1, 0}});
    EXPECT_CONTAINS(find_refusal(builder), "/accessors/0: POSITION 1 is not finite in component 1");
}

TEST(gltf_geometry, attributes_and_positions_of_different_number_are_refused) {
    GltfBuilder builder;
    const std::size_t positions = builder.add_vectors(RIGHT_TRIANGLE);
    const std::size_t normals = builder.add_vectors({{0, 0, 1}, {0, 0, 1}});
    builder.add_object({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
    EXPECT_CONTAINS(find_refusal(builder), "3 positions but 2 of NORMAL");
    builder.document["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", positions}, {"TEXCOORD_0", 1}};
    builder.document["accessors"][1]["type"] = "VEC2";
    EXPECT_CONTAINS(find_refusal(builder), "3 positions but 2 of TEXCOORD_0");
}

TEST(gltf_geometry, vertices_that_make_no_whole_triangles_are_refused) {
    GltfBuilder builder;
    builder.add_triangles({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
    EXPECT_CONTAINS(find_refusal(builder), "4 vertices make no whole number of triangles");
    GltfBuilder strip;
    const std::size_t positions = strip.add_vectors({{0, 0, 0}, {1, 0, 0}});
    strip.add_object({{"attributes", {{"POSITION", positions}}}, {"mode", 5}});
    EXPECT_CONTAINS(find_refusal(strip), "it draws triangles from 2 vertices");
}

TEST(gltf_geometry, references_to_what_does_not_exist_are_refused) {
    EXPECT_CONTAINS(refuse_edit("/meshes/0/primitives/0/attributes/POSITION", 2), "there is no accessor 2");
    EXPECT_CONTAINS(refuse_edit("/meshes/0/primitives/0/material", 0), "there is no material 0");
    EXPECT_CONTAINS(refuse_edit("/meshes/0/primitives/0/mode", 7), "7 is more than the 6");
    EXPECT_CONTAINS(refuse_edit("/accessors/0/bufferView", 2), "there is no buffer view 2");
    EXPECT_CONTAINS(refuse_edit("/nodes/0/mesh", 1), "there is no mesh 1");
    EXPECT_CONTAINS(refuse_edit("/nodes/0/camera", 0), "there is no camera 0");
}

TEST(gltf_geometry, values_of_the_wrong_kind_are_refused_where_they_stand) {
    for (const char* pointer : {"/meshes", "/nodes", "/accessors", "/bufferViews", "/buffers"})
        EXPECT_CONTAINS(refuse_edit(pointer, Json{{"0", 1}}), std::string(pointer) + ": an array was expected");
    for (const char* pointer : {"/meshes/0", "/nodes/0", "/accessors/0", "/bufferViews/0", "/buffers/0", "/asset"})
        EXPECT_CONTAINS(refuse_edit(pointer, 1), std::string(pointer) + ": an object was expected");
}

TEST(gltf_geometry, more_triangles_than_the_engine_takes_are_refused_before_they_are_made) {
    GltfBuilder builder;
    const std::size_t positions = builder.add_vectors(RIGHT_TRIANGLE);
    const std::size_t indices = builder.add_indices(std::vector<std::uint8_t>(3000, 0));
    builder.add_object({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    for (int i = 0; i < 40000; ++i) // 40,001 instances of 1,000 triangles
        builder.document["nodes"].push_back({{"mesh", 0}});
    EXPECT_CONTAINS(find_refusal(builder), "draws more than 33554432 triangles");
}

} // namespace
} // namespace photonloupe::test
