// SPDX-License-Identifier: Apache-2.0
// OpenEXR round trips, bit by bit, and refusals.
#include "image/exr.h"

#include <bit>
#include <cstring>
#include <limits>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <half.h>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/temporary_folder.h"

namespace photonloupe::test {
namespace {

Image make_image() {
    Image image{3, 2, {}, {}};
    for (int i = 0; i < 18; ++i)
        image.rgb.push_back(0.1f * float(i));
    image.attributes = {{"scene_hash", "0123abcd"}, {"settings", "{\"k\": 20, \"λ\": 1.2}"}, {"empty", ""}};
    return image;
}

std::string find_error(const std::filesystem::path& path) {
    try {
        read_exr(path);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(exr, pixels_come_back_bit_by_bit) {
    const TemporaryFolder folder;
    Image image = make_image();
    image.rgb[0] = std::numeric_limits<float>::quiet_NaN();
    image.rgb[1] = -std::numeric_limits<float>::infinity();
    image.rgb[2] = std::numeric_limits<float>::denorm_min();
    image.rgb[3] = 1e30f;
    write_exr(folder.get_path() / "a.exr", image);
    const Image copy = read_exr(folder.get_path() / "a.exr");
    ASSERT_EQ(copy.rgb.size(), image.rgb.size());
    EXPECT_EQ(copy.width, 3u);
    EXPECT_EQ(copy.height, 2u);
    EXPECT_EQ(std::memcmp(copy.rgb.data(), image.rgb.data(), image.rgb.size() * sizeof(float)), 0);
}

TEST(exr, attributes_come_back) {
    const TemporaryFolder folder;
    write_exr(folder.get_path() / "a.exr", make_image());
    EXPECT_EQ(read_exr(folder.get_path() / "a.exr").attributes, make_image().attributes);
}

TEST(exr, the_same_image_gives_the_same_file) {
    const TemporaryFolder folder;
    write_exr(folder.get_path() / "a.exr", make_image());
    write_exr(folder.get_path() / "b.exr", make_image());
    EXPECT_EQ(folder.read("a.exr"), folder.read("b.exr"));
}

TEST(exr, an_attribute_with_a_reserved_name_is_refused_and_nothing_is_written) {
    const TemporaryFolder folder;
    Image image = make_image();
    image.attributes["compression"] = "best";
    EXPECT_THROW(write_exr(folder.get_path() / "a.exr", image), Error);
    EXPECT_EQ(folder.count_files(), 0u);
}

TEST(exr, a_half_float_gray_image_with_an_offset_window_is_read_as_gray) {
    const TemporaryFolder folder;
    const std::string path = (folder.get_path() / "y.exr").string();
    const Imath::Box2i window({5, -3}, {6, -3});
    std::vector<half> pixels{half(0.5f), half(2.0f)};
    {
        Imf::Header header(window, window);
        header.channels().insert("Y", Imf::Channel(Imf::HALF));
        Imf::OutputFile file(path.c_str(), header);
        Imf::FrameBuffer frame;
        frame.insert("Y", Imf::Slice::Make(Imf::HALF, pixels.data(), window, sizeof(half), 2 * sizeof(half)));
        file.setFrameBuffer(frame);
        file.writePixels(1);
    }
    EXPECT_EQ(read_exr(path).rgb, (std::vector<float>{0.5f, 0.5f, 0.5f, 2.0f, 2.0f, 2.0f}));
}

TEST(exr, a_file_without_color_channels_is_refused_by_their_names) {
    const TemporaryFolder folder;
    const std::string path = (folder.get_path() / "z.exr").string();
    std::vector<float> pixels{1.0f};
    {
        Imf::Header header(1, 1);
        header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
        Imf::OutputFile file(path.c_str(), header);
        Imf::FrameBuffer frame;
        frame.insert("Z", Imf::Slice::Make(Imf::FLOAT, pixels.data(), header.dataWindow(), 4, 4));
        file.setFrameBuffer(frame);
        file.writePixels(1);
    }
    EXPECT_NE(find_error(path).find("neither R, G and B nor Y, but Z"), std::string::npos) << find_error(path);
}

TEST(exr, a_file_cut_anywhere_is_refused) {
    const TemporaryFolder folder;
    write_exr(folder.get_path() / "a.exr", make_image());
    const std::string whole = folder.read("a.exr");
    for (std::size_t size = 0; size < whole.size(); size += 7)
        EXPECT_NE(find_error(folder.write("cut.exr", whole.substr(0, size))), "") << size;
}

TEST(exr, every_flipped_byte_is_read_or_refused) {
    const TemporaryFolder folder;
    write_exr(folder.get_path() / "a.exr", make_image());
    const std::string whole = folder.read("a.exr");
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = char(~damaged[i]);
        find_error(folder.write("damaged.exr", damaged));
    }
}

TEST(exr, a_missing_file_is_named) {
    EXPECT_NE(find_error("/nowhere/a.exr").find("/nowhere/a.exr"), std::string::npos);
}

TEST(exr, an_image_with_too_few_values_is_refused) {
    const TemporaryFolder folder;
    EXPECT_THROW(write_exr(folder.get_path() / "a.exr", Image{2, 2, {1.0f}, {}}), Error);
    EXPECT_THROW(write_exr(folder.get_path() / "a.exr", Image{}), Error);
}

} // namespace
} // namespace photonloupe::test
