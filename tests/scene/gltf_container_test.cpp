// SPDX-License-Identifier: Apache-2.0
// Files that are not glTF, broken JSON, and GLB in all states of decay.
#include "scene/gltf_builder.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/temporary_folder.h"

namespace photonloupe::test {
namespace {

std::string encode_u32(std::uint32_t value) {
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8)
        bytes += char(value >> shift & 255);
    return bytes;
}

std::string make_chunk(const std::string& kind, const std::string& content) {
    return encode_u32(std::uint32_t(content.size())) + kind + content;
}

std::string make_glb(const std::string& chunks, std::uint32_t version = 2) {
    return "glTF" + encode_u32(version) + encode_u32(std::uint32_t(12 + chunks.size())) + chunks;
}

std::string make_triangle_glb() {
    const GltfBuilder builder = make_triangle();
    Json document = builder.document;
    document["buffers"] = Json::array({{{"byteLength", builder.get_buffer().size()}}});
    return make_glb(make_chunk("JSON", document.dump()) + make_chunk(std::string("BIN\0", 4), builder.get_buffer()));
}

TEST(gltf_container, a_glb_with_its_buffer_inside_loads) {
    EXPECT_EQ(load_text(make_triangle_glb()).triangles.size(), 1u);
}

TEST(gltf_container, a_glb_is_known_by_content_whatever_it_is_called) {
    const TemporaryFolder folder;
    EXPECT_EQ(load_scene(folder.write("scene.gltf", make_triangle_glb())).triangles.size(), 1u);
    EXPECT_EQ(load_scene(folder.write("scene.glb", make_triangle().finish().dump())).triangles.size(), 1u);
}

TEST(gltf_container, a_glb_cut_anywhere_is_refused) {
    const std::string whole = make_triangle_glb();
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_NE(find_text_refusal(whole.substr(0, size)), "") << size;
    EXPECT_CONTAINS(find_text_refusal(whole.substr(0, 100)), "the file has 100");
    EXPECT_CONTAINS(find_text_refusal(whole.substr(0, 15)), "no room for its header");
}

TEST(gltf_container, a_glb_chunk_longer_than_the_file_is_refused) {
    EXPECT_CONTAINS(find_text_refusal(make_glb(encode_u32(0xFFFFFFF0u) + "JSON{}")),
                    "GLB chunk 0 says 4294967280 bytes");
    EXPECT_CONTAINS(find_text_refusal(make_glb(make_chunk("JSON", "{} ") + "abc")), "GLB chunk 1 has no whole header");
}

TEST(gltf_container, a_glb_of_another_version_is_refused) {
    EXPECT_CONTAINS(find_text_refusal(make_glb(make_chunk("JSON", "{}"), 1)), "GLB container version 1");
}

TEST(gltf_container, a_glb_that_does_not_start_with_json_is_refused) {
    EXPECT_CONTAINS(find_text_refusal(make_glb(make_chunk(std::string("BIN\0", 4), "{} "))), "first chunk is not JSON");
}

TEST(gltf_container, chunks_of_unknown_kind_are_skipped) {
    EXPECT_EQ(
        find_text_refusal(make_glb(make_chunk("JSON", R"({"asset": {"version": "2.0"}})") + make_chunk("XYZW", "abc"))),
        "");
}

TEST(gltf_container, what_is_not_gltf_is_refused) {
    for (const char* text : {"", "   ", "hello", "[1, 2]", "\x89PNG\r\n", "solid stl"})
        EXPECT_CONTAINS(find_text_refusal(text), "test.gltf: neither glTF text (JSON) nor a GLB");
}

TEST(gltf_container, broken_json_is_refused_with_line_and_column) {
    EXPECT_CONTAINS(find_text_refusal("{\n  \"asset\": {,}\n}"), "line 2, column 13");
    EXPECT_CONTAINS(find_text_refusal("{\"a\": 1e999}"), "beyond the range");
    EXPECT_CONTAINS(find_text_refusal("{\"a\": \"\xFF\"}"), "can't be parsed");
}

TEST(gltf_container, deep_nesting_is_refused_before_it_is_parsed) {
    EXPECT_CONTAINS(find_text_refusal("{\"a\": " + std::string(1'000'000, '[')), "nested 1000001 deep");
    EXPECT_EQ(
        find_text_refusal(R"({"asset": {"version": "2.0", "generator": "[[[[)" + std::string(100, '[') + "\\\"[\"}}"),
        "");
}

TEST(gltf_container, a_byte_order_mark_is_accepted) {
    EXPECT_EQ(find_text_refusal("\xEF\xBB\xBF{\"asset\": {\"version\": \"2.0\"}}"), "");
}

TEST(gltf_container, a_missing_file_a_folder_and_a_device_are_refused_by_name) {
    const TemporaryFolder folder;
    for (const auto& path : {folder.get_path() / "missing.gltf", folder.get_path(), std::filesystem::path("/dev/zero")})
        try {
            load_scene(path);
            ADD_FAILURE() << path;
        } catch (const SceneError& error) {
            EXPECT_CONTAINS(error.what(), path.string());
        }
}

TEST(gltf_container, every_flipped_byte_of_a_scene_loads_or_is_refused) {
    for (const std::string& whole : {make_triangle_glb(), make_triangle().finish().dump()})
        for (std::size_t i = 0; i < whole.size(); ++i)
            for (const char mask : {1, 4, 32, 127}) {
                std::string damaged = whole;
                damaged[i] = char(damaged[i] ^ mask);
                find_text_refusal(damaged);
            }
}

} // namespace
} // namespace photonloupe::test
