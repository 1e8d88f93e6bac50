// SPDX-License-Identifier: Apache-2.0
// What a buffer's URI may name: every way out of the scene's folder is closed.
#include "scene/gltf_builder.h"

#include <sys/stat.h>

#include <gtest/gtest.h>

#include "core/temporary_folder.h"

namespace photonloupe::test {
namespace {

// A triangle whose buffer is the URI's file, in folder/scene; the buffer also lies beside and outside of it.
class GltfUri : public testing::Test {
protected:
    void SetUp() override {
        const std::string buffer = make_triangle().get_buffer();
        for (const char* name : {"outside.bin", "scene2/outside.bin", "scene/data.bin", "scene/sub/data.bin",
                                 "scene/a b.bin", "scene/%2e%2e.bin"})
            m_folder.write(name, buffer);
    }

    std::string find_uri_refusal(const std::string& uri, std::size_t byte_length = 36) {
        Json document = make_triangle().document;
        document["buffers"] = Json::array({{{"byteLength", byte_length}, {"uri", uri}}});
        return find_text_refusal(document.dump(), m_folder.get_path() / "scene");
    }

    TemporaryFolder m_folder;
};

TEST_F(GltfUri, files_in_and_below_the_folder_are_read) {
    for (const char* uri : {"data.bin", "sub/data.bin", "./data.bin", "sub/../data.bin", "a%20b.bin", "a b.bin"})
        EXPECT_EQ(find_uri_refusal(uri), "") << uri;
}

TEST_F(GltfUri, percent_escapes_are_decoded_exactly_once) {
    EXPECT_EQ(find_uri_refusal("%252e%252e.bin"), "");
}

TEST_F(GltfUri, leaving_the_folder_is_refused_plain_or_escaped) {
    for (const char* uri : {"../outside.bin", "%2e%2e/outside.bin", "%2E%2E%2Foutside.bin", "sub/../../outside.bin",
                            "../scene2/outside.bin", "missing/../../outside.bin", ".."})
        EXPECT_CONTAINS(find_uri_refusal(uri), "leads out of the scene's folder");
    EXPECT_CONTAINS(find_uri_refusal("../outside.bin"), "test.gltf: /buffers/0/uri: \"../outside.bin\"");
}

TEST_F(GltfUri, a_symbolic_link_out_of_the_folder_is_refused) {
    std::filesystem::create_symlink(m_folder.get_path() / "outside.bin", m_folder.get_path() / "scene/link.bin");
    std::filesystem::create_directory_symlink(m_folder.get_path(), m_folder.get_path() / "scene/up");
    EXPECT_CONTAINS(find_uri_refusal("link.bin"), "leads out of the scene's folder");
    EXPECT_CONTAINS(find_uri_refusal("up/outside.bin"), "leads out of the scene's folder");
}

TEST_F(GltfUri, a_symbolic_link_inside_the_folder_is_followed) {
    std::filesystem::create_symlink("sub/data.bin", m_folder.get_path() / "scene/link.bin");
    EXPECT_EQ(find_uri_refusal("link.bin"), "");
}

TEST_F(GltfUri, absolute_paths_are_refused) {
    EXPECT_CONTAINS(find_uri_refusal((m_folder.get_path() / "scene/data.bin").string()), "is an absolute path");
    EXPECT_CONTAINS(find_uri_refusal("%2fetc/passwd"), "is an absolute path");
    EXPECT_CONTAINS(find_uri_refusal("//host/data.bin"), "is an absolute path");
}

TEST_F(GltfUri, schemes_and_drives_are_refused) {
    for (const char* uri : {"file:data.bin", "file:///etc/passwd", "http://host/data.bin", "C:/data.bin",
                            "file%3Adata.bin", "DATA:application/octet-stream;base64,AAAA"})
        EXPECT_CONTAINS(find_uri_refusal(uri), "has a scheme or a drive");
}

TEST_F(GltfUri, backslash_nul_and_broken_escapes_are_refused) {
    EXPECT_CONTAINS(find_uri_refusal("sub\\data.bin"), "contains a backslash");
    EXPECT_CONTAINS(find_uri_refusal("..%5coutside.bin"), "contains a backslash");
    EXPECT_CONTAINS(find_uri_refusal("data.bin%00.txt"), "contains NUL");
    for (const char* uri : {"data%2", "data%", "data%zz.bin"})
        EXPECT_CONTAINS(find_uri_refusal(uri), "broken percent escape");
    EXPECT_CONTAINS(find_uri_refusal(""), "the URI is empty");
}

TEST_F(GltfUri, missing_files_folders_and_pipes_are_refused) {
    EXPECT_CONTAINS(find_uri_refusal("missing.bin"), "does not exist");
    EXPECT_CONTAINS(find_uri_refusal("sub"), "is not a regular file");
    ASSERT_EQ(::mkfifo((m_folder.get_path() / "scene/pipe.bin").c_str(), 0600), 0);
    EXPECT_CONTAINS(find_uri_refusal("pipe.bin"), "is not a regular file");
}

TEST_F(GltfUri, a_file_shorter_than_byte_length_is_refused) {
    EXPECT_CONTAINS(find_uri_refusal("data.bin", 37), "has 36 bytes, 37 are needed");
}

TEST_F(GltfUri, without_a_folder_only_embedded_data_is_accepted) {
    Json document = make_triangle().document;
    document["buffers"] = Json::array({{{"byteLength", 36}, {"uri", "data.bin"}}});
    EXPECT_CONTAINS(find_refusal(document), "has no folder");
}

TEST_F(GltfUri, data_uris_of_other_encodings_and_broken_base64_are_refused) {
    EXPECT_CONTAINS(find_uri_refusal("data:text/plain,hello"), "is not a data URI of a buffer");
    EXPECT_CONTAINS(find_uri_refusal("data:application/octet-stream,hello"), "is not a data URI of a buffer");
    const std::string prefix = "data:application/gltf-buffer;base64,";
    EXPECT_CONTAINS(find_uri_refusal(prefix + "AA!A"), "no base64 digit");
    EXPECT_CONTAINS(find_uri_refusal(prefix + "AAAAA"), "impossible length");
    EXPECT_CONTAINS(find_uri_refusal(prefix + "AAAA"), "byteLength is 36, but there are 3 bytes");
}

TEST_F(GltfUri, images_that_are_missing_or_lead_out_do_not_refuse_the_geometry) {
    Json document = make_triangle().finish();
    document["images"] = Json::parse(R"([{"uri":"missing.png"},{"uri":"../outside.bin"},{"uri":"http://host/a.png"}])");
    EXPECT_EQ(find_text_refusal(document.dump(), m_folder.get_path() / "scene"), "");
}

TEST_F(GltfUri, data_uris_of_any_media_type_are_read) {
    for (const char* prefix : {"data:;base64,", "data:text/plain;charset=utf-8;base64,"})
        EXPECT_CONTAINS(find_uri_refusal(std::string(prefix) + "AAAA"), "byteLength is 36, but there are 3 bytes");
}

} // namespace
} // namespace photonloupe::test
