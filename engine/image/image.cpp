// SPDX-License-Identifier: Apache-2.0
// Size checks that every image format shares.
#include "image/image.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/error.h"

namespace photonloupe {
namespace {

// Uncompressed float pixels and room for headers.
constexpr std::uint64_t MAX_FILE_BYTES = MAX_IMAGE_PIXELS * 16;

} // namespace

void check_image_size(std::uint64_t width, std::uint64_t height, const std::string& where) {
    if (width == 0 || height == 0 || width > MAX_IMAGE_SIDE || height > MAX_IMAGE_SIDE ||
        width * height > MAX_IMAGE_PIXELS)
        throw Error(where + ": an image of " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels; sides of 1 to " + std::to_string(MAX_IMAGE_SIDE) + " and at most " +
                    std::to_string(MAX_IMAGE_PIXELS) + " pixels are accepted");
}

void check_image(const Image& image, const std::string& where) {
    check_image_size(image.width, image.height, where);
    const std::uint64_t expected = 3ull * image.width * image.height;
    if (image.rgb.size() != expected)
        throw Error(where + ": " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                    " pixels need " + std::to_string(expected) + " values, there are " +
                    std::to_string(image.rgb.size()) + "; pass an array of (height, width, 3)");
}

std::vector<unsigned char> read_image_file(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw Error(path + ": there is no such file; check the name");
    const std::uint64_t size = std::filesystem::file_size(path, error);
    if (error || size > MAX_FILE_BYTES)
        throw Error(path + ": " + (error ? error.message() : "the file is too large for an image") +
                    "; give an image this program wrote");
    std::vector<unsigned char> bytes(size);
    std::ifstream stream(path, std::ios::binary);
    stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size));
    if (!stream)
        throw Error(path + ": can't be read: " + std::strerror(errno) + "; check its permissions");
    return bytes;
}

} // namespace photonloupe
