// SPDX-License-Identifier: Apache-2.0
// Meshes compressed by Draco and meshoptimizer read as they were, and broken ones are refused.
#include "scene/gltf_builder.h"

#include <cstring>

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

namespace photonloupe::test {
namespace {

// A strip of squares, waved so that no two triangles are alike.
constexpr std::uint32_t SQUARES = 20;
constexpr std::size_t VERTEX_COUNT = 2 * (SQUARES + 1), INDEX_COUNT = 6 * SQUARES;

Vectors make_positions() {
    Vectors positions;
    for (std::uint32_t i = 0; i <= SQUARES; ++i)
        for (const float y : {0.0f, 1.0f})
            positions.push_back({float(i), y, float(i * i % 7)});
    return positions;
}

std::vector<std::uint32_t> make_indices() {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < SQUARES; ++i)
        for (const std::uint32_t corner : {0u, 2u, 1u, 1u, 2u, 3u})
            indices.push_back(2 * i + corner);
    return indices;
}

double measure_area(const Scene& scene) {
    double area = 0;
    for (const shared::Triangle& triangle : scene.triangles) {
        const glm::dvec3 v0(triangle.v0_object);
        area +=
            0.5 * glm::length(glm::cross(glm::dvec3(triangle.v1_material) - v0, glm::dvec3(triangle.v2_source) - v0));
    }
    return area;
}

Scene load_plain() {
    GltfBuilder builder;
    const std::size_t positions = builder.add_vectors(make_positions());
    const std::size_t indices = builder.add_indices(make_indices());
    builder.add_object({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    return load(builder);
}

void expect_plain(const Scene& scene) {
    const Scene plain = load_plain();
    EXPECT_EQ(scene.triangles.size(), plain.triangles.size());
    EXPECT_EQ(scene.bounds.lo, plain.bounds.lo);
    EXPECT_EQ(scene.bounds.hi, plain.bounds.hi);
    EXPECT_NEAR(measure_area(scene), measure_area(plain), 1e-9);
}

// Damages one byte of a document's buffer after another; each either loads or is refused with SceneError.
void expect_survival(const GltfBuilder& builder) {
    std::size_t refused = 0;
    for (std::size_t i = 0; i < builder.get_buffer().size(); ++i)
        for (const int change : {0x01, 0x80, 0xFF}) {
            GltfBuilder damaged = builder;
            damaged.get_buffer()[i] = char(damaged.get_buffer()[i] ^ change);
            refused += !find_refusal(damaged).empty();
        }
    EXPECT_GT(refused, 0u);
}

// Draco

std::string encode_draco(int method) {
    draco::Mesh mesh;
    draco::GeometryAttribute kind;
    kind.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
    mesh.set_num_points(VERTEX_COUNT);
    const int id = mesh.AddAttribute(kind, true, VERTEX_COUNT);
    const Vectors positions = make_positions();
    for (std::uint32_t i = 0; i < VERTEX_COUNT; ++i)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), positions[i].data());
    mesh.SetNumFaces(INDEX_COUNT / 3);
    const std::vector<std::uint32_t> indices = make_indices();
    for (std::uint32_t i = 0; i < INDEX_COUNT / 3; ++i)
        mesh.SetFace(draco::FaceIndex(i), {{draco::PointIndex(indices[3 * i]), draco::PointIndex(indices[3 * i + 1]),
                                            draco::PointIndex(indices[3 * i + 2])}});
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
    return {buffer.data(), buffer.size()};
}

GltfBuilder make_draco(int method) {
    GltfBuilder builder;
    const std::string bytes = encode_draco(method);
    builder.document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    builder.document["accessors"] = {{{"componentType", 5126}, {"count", VERTEX_COUNT}, {"type", "VEC3"}},
                                     {{"componentType", 5125}, {"count", INDEX_COUNT}, {"type", "SCALAR"}}};
    builder.add_numbers(std::vector<char>(bytes.begin(), bytes.end()), bytes.size(), "SCALAR", 5121);
    builder.add_object(
        {{"attributes", {{"POSITION", 0}}},
         {"indices", 1},
         {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}}}}}});
    return builder;
}

TEST(compressed_meshes, draco_of_both_methods_reads_as_the_plain_mesh) {
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING})
        expect_plain(load(make_draco(method)));
}

TEST(compressed_meshes, draco_with_an_uncompressed_fallback_is_left_alone) {
    GltfBuilder builder;
    const std::size_t positions = builder.add_vectors(make_positions());
    const std::size_t indices = builder.add_indices(make_indices());
    builder.add_object({{"attributes", {{"POSITION", positions}}},
                        {"indices", indices},
                        {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", 99}}}}}});
    expect_plain(load(builder));
}

TEST(compressed_meshes, draco_that_is_no_mesh_is_refused_by_primitive) {
    GltfBuilder builder = make_draco(draco::MESH_EDGEBREAKER_ENCODING);
    builder.get_buffer()[0] = 'X';
    EXPECT_CONTAINS(find_refusal(builder),
                    "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: its data is no mesh of Draco 2.2");
    builder = make_draco(draco::MESH_EDGEBREAKER_ENCODING);
    builder.document["bufferViews"][0]["byteLength"] = 20;
    EXPECT_CONTAINS(find_refusal(builder), "its data c");
    builder = make_draco(draco::MESH_EDGEBREAKER_ENCODING);
    Json& extension = builder.document["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
    extension["attributes"]["POSITION"] = 7;
    EXPECT_CONTAINS(find_refusal(builder), "attributes/POSITION: the compressed data has no such attribute");
}

TEST(compressed_meshes, draco_that_claims_too_many_triangles_is_refused_before_memory_is_taken) {
    GltfBuilder builder = make_draco(draco::MESH_SEQUENTIAL_ENCODING);
    std::memcpy(builder.get_buffer().data() + 11, "\xFF\xFF\xFF\x7F", 4); // the number of triangles, 7 bits a byte
    EXPECT_CONTAINS(find_refusal(builder), "has more triangles than are decoded at once");
    builder = make_draco(draco::MESH_EDGEBREAKER_ENCODING);
    std::memcpy(builder.get_buffer().data() + 12, "\xFF\xFF\xFF\x7F", 4); // of vertices
    EXPECT_CONTAINS(find_refusal(builder), "has more triangles than are decoded at once");
}

TEST(compressed_meshes, damaged_draco_loads_or_is_refused) {
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING})
        expect_survival(make_draco(method));
}

// meshoptimizer

// A document whose buffer views are compressed, with a fallback buffer that has no bytes.
GltfBuilder make_meshopt(const char* index_mode) {
    GltfBuilder builder;
    const Vectors positions = make_positions();
    const std::vector<std::uint32_t> indices = make_indices();
    std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(VERTEX_COUNT, 12));
    vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), positions.data(), VERTEX_COUNT, 12));
    std::vector<unsigned char> corners(1000);
    const bool is_triangles = std::string_view(index_mode) == "TRIANGLES";
    corners.resize(is_triangles
                       ? meshopt_encodeIndexBuffer(corners.data(), corners.size(), indices.data(), INDEX_COUNT)
                       : meshopt_encodeIndexSequence(corners.data(), corners.size(), indices.data(), INDEX_COUNT));
    const auto add = [&](const std::vector<unsigned char>& bytes, const char* type, int component, const char* mode,
                         std::size_t count, std::size_t stride) {
        const std::size_t accessor = builder.add_numbers(bytes, count, type, component);
        Json& view = builder.document["bufferViews"][accessor];
        view["extensions"]["EXT_meshopt_compression"] = view;
        Json& extension = view["extensions"]["EXT_meshopt_compression"];
        extension.update({{"mode", mode}, {"count", count}, {"byteStride", stride}});
        view.update({{"buffer", 1}, {"byteOffset", 0}, {"byteLength", count * stride}});
    };
    add(vertices, "VEC3", 5126, "ATTRIBUTES", VERTEX_COUNT, 12);
    add(corners, "SCALAR", 5125, index_mode, INDEX_COUNT, 4);
    builder.document["extensionsRequired"] = {"EXT_meshopt_compression"};
    builder.more_buffers = {
        {{"byteLength", 1000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    builder.add_object({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
    return builder;
}

Json& get_meshopt(GltfBuilder& builder, std::size_t view) {
    return builder.document["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
}

TEST(compressed_meshes, meshopt_reads_as_the_plain_mesh) {
    for (const char* mode : {"TRIANGLES", "INDICES"})
        expect_plain(load(make_meshopt(mode)));
}

TEST(compressed_meshes, meshopt_filters_are_undone) {
    const std::vector<float> normals{0, 0, 1, 0, 0, 0.6f, 0.8f, 0, 1, 0, 0, 0};
    std::vector<std::int8_t> octahedral(12);
    meshopt_encodeFilterOct(octahedral.data(), 3, 4, 8, normals.data());
    std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(3, 4));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), octahedral.data(), 3, 4));
    GltfBuilder builder;
    builder.add_vectors(RIGHT_TRIANGLE);
    builder.add_numbers(bytes, 3, "VEC3", 5120);
    builder.document["accessors"][1]["normalized"] = true;
    Json& view = builder.document["bufferViews"][1];
    view["byteStride"] = 4;
    view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                     {"byteOffset", view["byteOffset"]},
                                                     {"byteLength", bytes.size()},
                                                     {"count", 3},
                                                     {"mode", "ATTRIBUTES"},
                                                     {"filter", "OCTAHEDRAL"},
                                                     {"byteStride", 4}};
    builder.add_object({{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}});
    const Scene scene = load(builder);
    EXPECT_LT(glm::length(glm::vec3(scene.normals.at(0).n1) - glm::vec3(0, 0.6f, 0.8f)), 0.02f);
    EXPECT_EQ(glm::vec3(scene.normals.at(0).n2), glm::vec3(1, 0, 0));
}

TEST(compressed_meshes, meshopt_parameters_that_the_extension_lacks_are_refused) {
    const auto refuse_edit = [](std::size_t view, const char* key, const Json& value) {
        GltfBuilder builder = make_meshopt("TRIANGLES");
        get_meshopt(builder, view)[key] = value;
        return find_refusal(builder);
    };
    for (const Json& stride : {Json(6), Json(0)})
        EXPECT_CONTAINS(refuse_edit(0, "byteStride", stride), "are nothing that EXT_meshopt_compression has");
    EXPECT_CONTAINS(refuse_edit(0, "byteStride", 260), "260 is more than the 256");
    EXPECT_CONTAINS(refuse_edit(0, "mode", "ZIP"), "mode \"ZIP\"");
    EXPECT_CONTAINS(refuse_edit(0, "filter", "OCTAHEDRAL"), "filter \"OCTAHEDRAL\"");
    EXPECT_CONTAINS(refuse_edit(1, "count", 119), "are nothing that EXT_meshopt_compression has");
    EXPECT_CONTAINS(refuse_edit(0, "count", 41), "its 42 elements end at byte 504 of a buffer view of 492");
    EXPECT_CONTAINS(refuse_edit(0, "count", 2000000000), "what is decoded exceeds");
    EXPECT_CONTAINS(refuse_edit(0, "byteLength", 20), "its data can't be decompressed");
    EXPECT_CONTAINS(refuse_edit(0, "buffer", 1), "of buffer 1, which has 0");
}

TEST(compressed_meshes, damaged_meshopt_loads_or_is_refused) {
    expect_survival(make_meshopt("TRIANGLES"));
    expect_survival(make_meshopt("INDICES"));
}

} // namespace
} // namespace photonloupe::test
