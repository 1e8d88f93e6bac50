// SPDX-License-Identifier: Apache-2.0
// libpng, libjpeg-turbo and libwebp behind one value.
#include "image/decode_image.h"

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>

#include <turbojpeg.h>
#include <webp/decode.h>

#include "core/error.h"
#include "image/png.h"

namespace photonloupe {
namespace {

unsigned char* get_bytes(RgbaImage& image) {
    return reinterpret_cast<unsigned char*>(image.texels.data());
}

RgbaImage decode_jpeg(std::span<const unsigned char> bytes) {
    const std::unique_ptr<void, decltype(&tjDestroy)> decoder(tjInitDecompress(), &tjDestroy);
    if (!decoder)
        throw Error("out of memory; close other programs");
    const auto refuse = [&] { throw Error(std::string("it is no readable JPEG: ") + tjGetErrorStr2(decoder.get())); };
    int width = 0, height = 0, subsampling = 0, color_space = 0;
    const auto size = static_cast<unsigned long>(bytes.size());
    if (tjDecompressHeader3(decoder.get(), bytes.data(), size, &width, &height, &subsampling, &color_space) != 0)
        refuse();
    if (width <= 0 || height <= 0)
        throw Error("it is no readable JPEG: its header gives no size");
    RgbaImage image = make_texels(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
    // A warning, such as a few bytes too many, leaves a picture.
    const int flags = TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS;
    if (tjDecompress2(decoder.get(), bytes.data(), size, get_bytes(image), width, 0, height, TJPF_RGBA, flags) != 0 &&
        tjGetErrorCode(decoder.get()) != TJERR_WARNING)
        refuse();
    return image;
}

RgbaImage decode_webp(std::span<const unsigned char> bytes) {
    int width = 0, height = 0;
    if (!WebPGetInfo(bytes.data(), bytes.size(), &width, &height))
        throw Error("it is no readable WebP");
    RgbaImage image = make_texels(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
    const std::size_t size = image.texels.size() * sizeof(std::uint32_t);
    if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), get_bytes(image), size, 4 * width))
        throw Error("its WebP data is damaged");
    return image;
}

bool starts_with(std::span<const unsigned char> bytes, std::string_view signature, std::size_t offset = 0) {
    return bytes.size() >= offset + signature.size() &&
           std::equal(signature.begin(), signature.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset),
                      [](char a, unsigned char b) { return static_cast<unsigned char>(a) == b; });
}

} // namespace

RgbaImage make_texels(std::uint64_t width, std::uint64_t height) {
    if (width == 0 || height == 0 || width > MAX_TEXTURE_SIDE || height > MAX_TEXTURE_SIDE ||
        width * height > MAX_TEXTURE_PIXELS)
        throw Error("its header says " + std::to_string(width) + " × " + std::to_string(height) +
                    " pixels; textures have 1 to " + std::to_string(MAX_TEXTURE_SIDE) + " on a side, " +
                    std::to_string(MAX_TEXTURE_PIXELS) + " at most");
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
            std::vector<std::uint32_t>(width * height)};
}

RgbaImage decode_image(std::span<const unsigned char> bytes) {
    if (starts_with(bytes, "\x89PNG"))
        return decode_png_texels({bytes.begin(), bytes.end()});
    if (starts_with(bytes, "\xff\xd8\xff"))
        return decode_jpeg(bytes);
    if (starts_with(bytes, "RIFF") && starts_with(bytes, "WEBP", 8))
        return decode_webp(bytes);
    if (starts_with(bytes, "\xabKTX 20"))
        throw Error("KTX 2 (Basis Universal) textures are not read");
    throw Error("it is neither PNG, JPEG nor WebP");
}

} // namespace photonloupe
