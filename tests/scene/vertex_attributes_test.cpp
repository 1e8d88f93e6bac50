// SPDX-License-Identifier: Apache-2.0
// What vertices may be stored as: quantized, sparse, unaligned, without bytes; and what is not finite.
#include "scene/gltf_builder.h"

#include <cmath>
#include <limits>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <gtest/gtest.h>

#include "scene/primitive_reader.h"

namespace photonloupe::test {
namespace {

constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

// The document with accessor 0 as the corners of its one triangle.
Scene load_positions(GltfBuilder builder) {
    builder.add_object({{"attributes", {{"POSITION", 0}}}});
    return load(builder);
}

glm::vec3 find_second_corner(const Scene& scene) {
    return scene.triangles.size() == 1 ? glm::vec3(scene.triangles[0].v1_material) : glm::vec3(NOT_A_NUMBER);
}

TEST(vertex_attributes, positions_may_be_integers_of_8_and_16_bits) {
    GltfBuilder bytes, shorts, unsigned_bytes, unsigned_shorts;
    bytes.add_numbers<std::int8_t>({0, 0, 0, 100, -7, 0, 0, 9, 0}, 3, "VEC3", 5120);
    shorts.add_numbers<std::int16_t>({0, 0, 0, 30000, -7, 0, 0, 9, 0}, 3, "VEC3", 5122);
    unsigned_bytes.add_numbers<std::uint8_t>({0, 0, 0, 200, 7, 0, 0, 9, 0}, 3, "VEC3", 5121);
    unsigned_shorts.add_numbers<std::uint16_t>({0, 0, 0, 60000, 7, 0, 0, 9, 0}, 3, "VEC3", 5123);
    EXPECT_EQ(find_second_corner(load_positions(bytes)), glm::vec3(100, -7, 0));
    EXPECT_EQ(find_second_corner(load_positions(shorts)), glm::vec3(30000, -7, 0));
    EXPECT_EQ(find_second_corner(load_positions(unsigned_bytes)), glm::vec3(200, 7, 0));
    EXPECT_EQ(find_second_corner(load_positions(unsigned_shorts)), glm::vec3(60000, 7, 0));
}

TEST(vertex_attributes, normalized_integers_stand_for_at_most_1_and_at_least_minus_1) {
    GltfBuilder bytes, shorts;
    bytes.add_numbers<std::int8_t>({0, 0, 0, 127, -128, 0, 0, 9, 0}, 3, "VEC3", 5120);
    shorts.add_numbers<std::uint16_t>({0, 0, 0, 65535, 13107, 0, 0, 9, 0}, 3, "VEC3", 5123);
    bytes.document["accessors"][0]["normalized"] = shorts.document["accessors"][0]["normalized"] = true;
    EXPECT_EQ(find_second_corner(load_positions(bytes)), glm::vec3(1, -1, 0));
    EXPECT_EQ(find_second_corner(load_positions(shorts)), glm::vec3(1, 0.2f, 0));
}

TEST(vertex_attributes, the_extension_of_quantized_vertices_may_be_required) {
    GltfBuilder builder = make_triangle();
    builder.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    EXPECT_EQ(find_refusal(builder), "");
}

TEST(vertex_attributes, elements_need_no_alignment) {
    GltfBuilder builder;
    std::vector<unsigned char> bytes(2 + 3 * 13);
    for (std::size_t i = 0; i < 3; ++i)
        std::memcpy(&bytes[2 + 13 * i], RIGHT_TRIANGLE[i].data(), 12);
    builder.add_numbers(bytes, 3, "VEC3", 5126);
    builder.document["accessors"][0]["byteOffset"] = 2;
    builder.document["bufferViews"][0]["byteStride"] = 13;
    EXPECT_EQ(find_second_corner(load_positions(builder)), glm::vec3(1, 0, 0));
}

// A triangle whose second corner a sparse accessor puts at (5, 6, 7).
GltfBuilder make_sparse(std::uint16_t replaced) {
    GltfBuilder builder;
    builder.add_vectors(RIGHT_TRIANGLE);
    builder.add_vectors({{5, 6, 7}});
    builder.add_indices<std::uint16_t>({replaced});
    builder.document["accessors"][0]["sparse"] = {
        {"count", 1}, {"indices", {{"bufferView", 2}, {"componentType", 5123}}}, {"values", {{"bufferView", 1}}}};
    return builder;
}

TEST(vertex_attributes, sparse_accessors_replace_elements_of_their_base_or_of_zeros) {
    GltfBuilder builder = make_sparse(1);
    const Scene scene = load_positions(builder);
    EXPECT_EQ(find_second_corner(scene), glm::vec3(5, 6, 7));
    EXPECT_EQ(glm::vec3(scene.triangles.at(0).v2_source), glm::vec3(0, 1, 0));
    builder.document["accessors"][0].erase("bufferView");
    EXPECT_TRUE(contains(load_positions(builder).report.notes, "1 triangle of zero area was dropped"));
    EXPECT_EQ(load_positions(builder).bounds.hi, (std::array<double, 3>{5, 6, 7}));
}

TEST(vertex_attributes, sparse_accessors_that_do_not_fit_are_refused) {
    GltfBuilder beyond = make_sparse(3);
    beyond.add_object({{"attributes", {{"POSITION", 0}}}});
    EXPECT_CONTAINS(find_refusal(beyond), "/accessors/0/sparse: it replaces element 3 of 3");
    const auto refuse_sparse = [](const char* pointer, const Json& value) {
        GltfBuilder builder = make_sparse(1);
        builder.add_object({{"attributes", {{"POSITION", 0}}}});
        Json document = builder.finish();
        document[Json::json_pointer(std::string("/accessors/0/sparse") + pointer)] = value;
        return find_refusal(document);
    };
    EXPECT_CONTAINS(refuse_sparse("/count", 0), "count is 0");
    EXPECT_CONTAINS(refuse_sparse("/count", 4), "4 is more than the 3");
    EXPECT_CONTAINS(refuse_sparse("/count", 2), "/accessors/0/sparse/indices: its 2 elements end at byte 4");
    EXPECT_CONTAINS(refuse_sparse("/indices/componentType", 5120), "sparse indices must be of unsigned");
    EXPECT_CONTAINS(refuse_sparse("/values/byteOffset", 4), "/accessors/0/sparse/values: its 1 elements end at");
}

TEST(vertex_attributes, sparse_accessors_that_need_too_much_memory_are_refused) {
    GltfBuilder builder = make_sparse(1);
    builder.add_object({{"attributes", {{"POSITION", 0}}}});
    builder.document["accessors"][0].erase("bufferView");
    builder.document["accessors"][0]["count"] = 2147483646;
    EXPECT_CONTAINS(find_refusal(builder), "what is decoded exceeds 2147483647 bytes");
}

TEST(vertex_attributes, accessors_without_a_view_are_zeros) {
    GltfBuilder builder = make_triangle();
    builder.document["accessors"][0].erase("bufferView");
    EXPECT_TRUE(contains(load(builder).report.notes, "zero area"));
}

TEST(vertex_attributes, broken_accessors_are_listed_where_nothing_drawn_uses_them) {
    GltfBuilder builder = make_triangle();
    builder.document["accessors"].push_back({{"type", "VEC9"}, {"componentType", 5126}, {"count", 1}});
    builder.document["meshes"].push_back({{"primitives", Json::parse(R"([{"attributes":{"POSITION":1}}])")}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_TRUE(
        contains(scene.report.ignored, "broken accessors that nothing drawn uses (1): test.gltf: /accessors/1"));
    builder.document["nodes"].push_back({{"mesh", 1}});
    EXPECT_CONTAINS(find_refusal(builder), "/accessors/1: type \"VEC9\"");
}

TEST(vertex_attributes, normals_that_are_not_finite_become_geometric_and_are_noted) {
    GltfBuilder builder;
    builder.add_vectors(RIGHT_TRIANGLE);
    builder.add_vectors({{0, NOT_A_NUMBER, 1}, {std::numeric_limits<float>::infinity(), 0, 1}, {0, 0, 1}});
    builder.add_object({{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}});
    const Scene scene = load(builder);
    EXPECT_EQ(glm::vec3(scene.normals.at(0).n0), glm::vec3(0, 0, 1));
    EXPECT_EQ(glm::vec3(scene.normals.at(0).n1), glm::vec3(0, 0, 1));
    EXPECT_TRUE(contains(scene.report.notes, "2 shading normals of zero length or not finite were replaced"));
}

TEST(vertex_attributes, texture_coordinates_that_are_not_finite_are_listed) {
    GltfBuilder builder;
    builder.add_vectors(RIGHT_TRIANGLE);
    builder.add_numbers<float>({0, 0, NOT_A_NUMBER, 1, 1, 1}, 3, "VEC2", 5126);
    builder.add_object({{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}});
    EXPECT_TRUE(contains(load(builder).report.ignored, "/accessors/1: numbers that are not finite (1) are 0"));
}

TEST(vertex_attributes, colors_and_texture_coordinates_are_read_as_they_are_stored) {
    const std::vector<float> floats{0.25f, NOT_A_NUMBER, 0.75f, 0.5f};
    const std::vector<std::uint8_t> bytes{255, 0, 51, 102};
    const auto view = [](const auto& numbers, std::uint64_t type, std::uint32_t width) {
        AccessorColumn column;
        column.bytes = reinterpret_cast<const unsigned char*>(numbers.data());
        column.component_type = type;
        column.width = width;
        column.count = 1;
        return column;
    };
    const std::vector<AccessorColumn> columns{view(floats, COMPONENT_FLOAT, 3), view(floats, COMPONENT_FLOAT, 2),
                                              view(bytes, COMPONENT_UNSIGNED_BYTE, 4),
                                              view(bytes, COMPONENT_UNSIGNED_BYTE, 2)};
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes = {{"POSITION", 0}, {"TEXCOORD_0", 1}, {"TEXCOORD_1", 3}, {"COLOR_0", 2}};
    const PrimitiveReader reader(primitive, columns);
    EXPECT_EQ(reader.read_texcoord(0, 0), glm::dvec2(0.25, 0));
    EXPECT_EQ(reader.read_texcoord(1, 0), glm::dvec2(255, 0));
    EXPECT_EQ(reader.read_color(0), glm::dvec4(1, 0, 0.2, 0.4));
    EXPECT_FALSE(reader.has_normals());
    primitive.attributes["COLOR_0"] = 0;
    EXPECT_EQ(PrimitiveReader(primitive, columns).read_color(0), glm::dvec4(0.25, 0, 0.75, 1));
}

} // namespace
} // namespace photonloupe::test
