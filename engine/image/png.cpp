// SPDX-License-Identifier: Apache-2.0
// libpng behind values: its longjmp never crosses an object with a destructor.
#include "image/png.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <png.h>

#include "core/atomic_file.h"
#include "core/error.h"

namespace photonloupe {
namespace {

// PNG specification, section 11.3.4.2: keywords of 1 to 79 bytes.
constexpr std::size_t MAX_KEYWORD_LENGTH = 79;
// Text chunks of a file someone else made.
constexpr png_alloc_size_t MAX_CHUNK_BYTES = 8u << 20;

// Where libpng leaves its message, and what it reads from or writes to.
struct Transfer {
    std::string error;
    std::vector<unsigned char> written;
    const std::vector<unsigned char>* source = nullptr;
    std::size_t position = 0;
};

// libpng asks for an error handler that does not return. Everything with a destructor lives in the callers.
[[noreturn]] void store_error(png_structp png, png_const_charp message) {
    static_cast<Transfer*>(png_get_error_ptr(png))->error = message;
    png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

void append_bytes(png_structp png, png_bytep bytes, std::size_t count) {
    auto& written = static_cast<Transfer*>(png_get_io_ptr(png))->written;
    written.insert(written.end(), bytes, bytes + count);
}

void flush_nothing(png_structp) {}

void take_bytes(png_structp png, png_bytep bytes, std::size_t count) {
    auto& transfer = *static_cast<Transfer*>(png_get_io_ptr(png));
    if (count > transfer.source->size() - transfer.position)
        png_error(png, "the file ends too early");
    std::memcpy(bytes, transfer.source->data() + transfer.position, count);
    transfer.position += count;
}

bool is_plain_text(const std::string& text) {
    return std::all_of(text.begin(), text.end(), [](unsigned char c) { return c == '\n' || (c >= 0x20 && c < 0x7F); });
}

// The texts point into `attributes`.
std::vector<png_text> make_texts(const std::map<std::string, std::string>& attributes) {
    std::vector<png_text> texts;
    for (const auto& [name, value] : attributes) {
        if (name.empty() || name.size() > MAX_KEYWORD_LENGTH || !is_plain_text(name))
            throw Error("PNG attribute \"" + name + "\": names are 1 to 79 ASCII characters; rename it");
        if (value.find('\0') != std::string::npos)
            throw Error("PNG attribute \"" + name + "\": its value contains NUL; remove it");
        png_text text{};
        text.compression = is_plain_text(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        text.key = const_cast<char*>(name.c_str()); // libpng only reads them
        text.text = const_cast<char*>(value.c_str());
        text.text_length = value.size();
        texts.push_back(text);
    }
    return texts;
}

// Only trivial locals: an error jumps out of the middle.
bool write_rows(png_structp png, png_infop info, const Image& image, const std::vector<png_text>& texts,
                const std::vector<std::uint8_t>& pixels) {
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_set_user_limits(png, MAX_IMAGE_SIDE, MAX_IMAGE_SIDE);
    png_set_IHDR(png, info, image.width, image.height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_RELATIVE);
    if (!texts.empty())
        png_set_text(png, info, texts.data(), int(texts.size()));
    png_write_info(png, info);
    for (std::size_t row = 0; row < image.height; ++row)
        png_write_row(png, pixels.data() + row * image.width * 3);
    png_write_end(png, info);
    return true;
}

// Only trivial locals, as above. Leaves the stream before the first row.
bool read_header(png_structp png, png_infop info, bool keeps_alpha, std::uint32_t largest_side) {
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_set_user_limits(png, largest_side, largest_side);
    png_set_chunk_malloc_max(png, MAX_CHUNK_BYTES);
    png_read_info(png, info);
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    if (keeps_alpha)
        png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
    else
        png_set_strip_alpha(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    return true;
}

bool read_rows(png_structp png, png_infop info, png_bytepp rows) {
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_read_image(png, rows);
    png_read_end(png, info);
    return true;
}

struct Writer {
    png_structp png;
    png_infop info;

    explicit Writer(Transfer& transfer)
        : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &transfer, store_error, ignore_warning)),
          info(png ? png_create_info_struct(png) : nullptr) {
        if (!info)
            throw Error("PNG: out of memory; close other programs");
        png_set_write_fn(png, &transfer, append_bytes, flush_nothing);
    }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
    ~Writer() { png_destroy_write_struct(&png, &info); }
};

struct Reader {
    png_structp png;
    png_infop info;

    explicit Reader(Transfer& transfer)
        : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &transfer, store_error, ignore_warning)),
          info(png ? png_create_info_struct(png) : nullptr) {
        if (!info)
            throw Error("PNG: out of memory; close other programs");
        png_set_read_fn(png, &transfer, take_bytes);
    }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void read_all_rows(Reader& reader, const Transfer& transfer, unsigned char* pixels, std::size_t height,
                   std::size_t row_bytes) {
    if (png_get_rowbytes(reader.png, reader.info) != row_bytes)
        throw Error("its pixels can't be converted to 8 bits a channel");
    std::vector<png_bytep> rows;
    for (std::size_t row = 0; row < height; ++row)
        rows.push_back(pixels + row * row_bytes);
    if (!read_rows(reader.png, reader.info, rows.data()))
        throw Error(transfer.error);
}

PngImage decode_png(const std::vector<unsigned char>& bytes) {
    Transfer transfer;
    transfer.source = &bytes;
    Reader reader(transfer);
    if (!read_header(reader.png, reader.info, false, MAX_IMAGE_SIDE))
        throw Error(transfer.error);
    PngImage image;
    image.width = png_get_image_width(reader.png, reader.info);
    image.height = png_get_image_height(reader.png, reader.info);
    check_image_size(image.width, image.height, "its header");
    image.rgb.resize(3ull * image.width * image.height);
    read_all_rows(reader, transfer, image.rgb.data(), image.height, 3ull * image.width);
    png_textp texts = nullptr;
    int text_count = 0;
    png_get_text(reader.png, reader.info, &texts, &text_count);
    for (int i = 0; i < text_count; ++i)
        image.attributes[texts[i].key] = texts[i].text ? texts[i].text : "";
    return image;
}

} // namespace

RgbaImage decode_png_texels(const std::vector<unsigned char>& bytes) {
    Transfer transfer;
    transfer.source = &bytes;
    Reader reader(transfer);
    if (!read_header(reader.png, reader.info, true, MAX_TEXTURE_SIDE))
        throw Error("it is no readable PNG: " + transfer.error);
    RgbaImage image =
        make_texels(png_get_image_width(reader.png, reader.info), png_get_image_height(reader.png, reader.info));
    read_all_rows(reader, transfer, reinterpret_cast<unsigned char*>(image.texels.data()), image.height,
                  4ull * image.width);
    return image;
}

std::uint8_t encode_srgb(float linear, double exposure) {
    const double value = linear * std::exp2(exposure);
    if (!(value > 0.0))
        return 0; // negative and NaN
    const double clipped = std::min(value, 1.0);
    // IEC 61966-2-1
    const double encoded = clipped <= 0.0031308 ? 12.92 * clipped : 1.055 * std::pow(clipped, 1 / 2.4) - 0.055;
    return std::uint8_t(encoded * 255.0 + 0.5);
}

std::vector<unsigned char> encode_png(const Image& image, double exposure) {
    check_image(image, "PNG");
    if (!std::isfinite(exposure))
        throw Error("PNG: the exposure is not finite; give it in stops, such as -1.5");
    std::vector<std::uint8_t> pixels(image.rgb.size());
    std::transform(image.rgb.begin(), image.rgb.end(), pixels.begin(),
                   [exposure](float linear) { return encode_srgb(linear, exposure); });
    const std::vector<png_text> texts = make_texts(image.attributes);
    Transfer transfer;
    Writer writer(transfer);
    if (!write_rows(writer.png, writer.info, image, texts, pixels))
        throw Error("PNG: can't be encoded: " + transfer.error + "; check the attributes");
    return std::move(transfer.written);
}

void write_png(const std::filesystem::path& path, const Image& image, double exposure) {
    write_file_atomically(path, encode_png(image, exposure));
}

PngImage read_png(const std::filesystem::path& path) {
    const std::vector<unsigned char> bytes = read_image_file(path.string());
    try {
        return decode_png(bytes);
    } catch (const Error& error) {
        throw Error(path.string() + ": can't be read as PNG: " + error.what() + "; give a PNG file");
    }
}

} // namespace photonloupe
