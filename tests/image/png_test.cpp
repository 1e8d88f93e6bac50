// SPDX-License-Identifier: Apache-2.0
// PNG: the sRGB curve, text chunks, refusals.
#include "image/png.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/temporary_folder.h"

namespace photonloupe::test {
namespace {

Image make_image() {
    return {2, 1, {0.0f, 0.5f, 1.0f, 0.25f, 2.0f, -1.0f}, {{"seed", "1"}, {"λ", "1"}}};
}

TEST(png, values_follow_the_srgb_curve) {
    EXPECT_EQ(encode_srgb(0.0f, 0.0), 0);
    EXPECT_EQ(encode_srgb(0.0031308f, 0.0), 10);
    EXPECT_EQ(encode_srgb(0.2158605f, 0.0), 128);
    EXPECT_EQ(encode_srgb(0.5f, 0.0), 188);
    EXPECT_EQ(encode_srgb(1.0f, 0.0), 255);
}

TEST(png, exposure_is_counted_in_stops) {
    EXPECT_EQ(encode_srgb(0.125f, 2.0), encode_srgb(0.5f, 0.0));
    EXPECT_EQ(encode_srgb(4.0f, -3.0), encode_srgb(0.5f, 0.0));
}

TEST(png, values_out_of_range_are_clipped_and_nan_is_black) {
    EXPECT_EQ(encode_srgb(-1.0f, 0.0), 0);
    EXPECT_EQ(encode_srgb(1e30f, 0.0), 255);
    EXPECT_EQ(encode_srgb(std::numeric_limits<float>::infinity(), 0.0), 255);
    EXPECT_EQ(encode_srgb(std::numeric_limits<float>::quiet_NaN(), 0.0), 0);
}

TEST(png, pixels_and_attributes_come_back) {
    const TemporaryFolder folder;
    Image image = make_image();
    image.attributes = {{"seed", "1"}, {"settings", "λ = 2\nk = 20"}};
    write_png(folder.get_path() / "a.png", image, 0.0);
    const PngImage copy = read_png(folder.get_path() / "a.png");
    EXPECT_EQ(copy.width, 2u);
    EXPECT_EQ(copy.height, 1u);
    EXPECT_EQ(copy.rgb, (std::vector<std::uint8_t>{0, 188, 255, 137, 255, 0}));
    EXPECT_EQ(copy.attributes, image.attributes);
}

TEST(png, encoding_to_memory_gives_the_same_bytes_as_the_file) {
    const TemporaryFolder folder;
    Image image = make_image();
    image.attributes.clear();
    write_png(folder.get_path() / "a.png", image, 1.0);
    const std::vector<unsigned char> bytes = encode_png(image, 1.0);
    EXPECT_EQ(folder.read("a.png"), std::string(bytes.begin(), bytes.end()));
}

TEST(png, an_attribute_whose_name_is_not_ascii_is_refused) {
    EXPECT_THROW(encode_png(make_image(), 0.0), Error);
}

TEST(png, an_exposure_that_is_not_finite_is_refused) {
    EXPECT_THROW(encode_png({1, 1, {0, 0, 0}, {}}, std::numeric_limits<double>::quiet_NaN()), Error);
}

TEST(png, every_damaged_or_cut_file_is_read_or_refused) {
    const TemporaryFolder folder;
    write_png(folder.get_path() / "a.png", {2, 1, {0, 0, 0, 1, 1, 1}, {{"seed", "1"}}}, 0.0);
    const std::string whole = folder.read("a.png");
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = char(~damaged[i]);
        try {
            read_png(folder.write("damaged.png", damaged));
        } catch (const Error&) {
        }
        EXPECT_THROW(read_png(folder.write("cut.png", whole.substr(0, i))), Error) << i;
    }
}

} // namespace
} // namespace photonloupe::test
