// SPDX-License-Identifier: Apache-2.0
// Atomic writing: whole content, no leftovers, clear errors.
#include "core/atomic_file.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/temporary_folder.h"

namespace photonloupe::test {
namespace {

std::span<const unsigned char> view_bytes(std::string_view text) {
    return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

std::string find_error(const std::filesystem::path& path) {
    try {
        write_file_atomically(path, view_bytes("x"));
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(atomic_file, a_new_file_has_the_whole_content) {
    const TemporaryFolder folder;
    const std::string content(1 << 20, 'x');
    write_file_atomically(folder.get_path() / "a.bin", view_bytes(content));
    EXPECT_EQ(folder.read("a.bin"), content);
}

TEST(atomic_file, an_old_file_is_replaced_and_nothing_is_left_beside_it) {
    const TemporaryFolder folder;
    folder.write("a.bin", "old and longer");
    write_file_atomically(folder.get_path() / "a.bin", view_bytes("new"));
    EXPECT_EQ(folder.read("a.bin"), "new");
    EXPECT_EQ(folder.count_files(), 1u);
}

TEST(atomic_file, an_empty_file_can_be_written) {
    const TemporaryFolder folder;
    write_file_atomically(folder.get_path() / "a.bin", {});
    EXPECT_EQ(folder.count_files(), 1u);
}

TEST(atomic_file, a_missing_folder_is_named_with_the_reason) {
    const TemporaryFolder folder;
    const std::string error = find_error(folder.get_path() / "missing" / "a.bin");
    EXPECT_NE(error.find("missing/a.bin"), std::string::npos) << error;
    EXPECT_NE(error.find("No such file or directory"), std::string::npos) << error;
}

TEST(atomic_file, a_failed_rename_leaves_no_temporary_file) {
    const TemporaryFolder folder;
    folder.write("a/file", "content"); // "a" is a folder: nothing can be renamed over it
    EXPECT_NE(find_error(folder.get_path() / "a").find("rename"), std::string::npos);
    EXPECT_EQ(folder.count_files(), 1u);
}

TEST(atomic_file, a_temporary_file_of_a_killed_process_is_in_nobodys_way) {
    const TemporaryFolder folder;
    folder.write("a.bin.tmp" + std::to_string(::getpid()) + "-0", "half");
    write_file_atomically(folder.get_path() / "a.bin", view_bytes("whole"));
    EXPECT_EQ(folder.read("a.bin"), "whole");
}

} // namespace
} // namespace photonloupe::test
