// SPDX-License-Identifier: Apache-2.0
// One copy of each image, whoever uses it; a texture is an image with its sampler, transform and coordinates.
#include "scene/load_textures.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/json_place.h"
#include "image/decode_image.h"
#include "scene/limits.h"

namespace photonloupe {
namespace {

// IEC 61966-2-1, of the 256 codes.
std::vector<std::uint32_t> make_srgb_table() {
    std::vector<std::uint32_t> table;
    for (std::uint32_t code = 0; code < shared::ATLAS_TABLE_SIZE; ++code) {
        const double encoded = code / 255.0;
        const double linear = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
        table.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(linear)));
    }
    return table;
}

std::uint32_t get_code(std::uint32_t texel, int channel) {
    return texel >> (8 * channel) & 0xffu;
}

// Each texel the mean of up to four, as its codes stand.
RgbaImage halve(const RgbaImage& image) {
    RgbaImage half{(image.width + 1) / 2, (image.height + 1) / 2, {}};
    half.texels.reserve(std::size_t{half.width} * half.height);
    for (std::uint32_t row = 0; row < half.height; ++row)
        for (std::uint32_t column = 0; column < half.width; ++column) {
            std::uint32_t texel = 0;
            for (int channel = 0; channel < 4; ++channel) {
                std::uint32_t sum = 2;
                for (std::uint32_t corner = 0; corner < 4; ++corner) {
                    const std::uint32_t x = std::min(2 * column + corner % 2, image.width - 1);
                    const std::uint32_t y = std::min(2 * row + corner / 2, image.height - 1);
                    sum += get_code(image.texels[std::size_t{y} * image.width + x], channel);
                }
                texel |= sum / 4 << (8 * channel);
            }
            half.texels.push_back(texel);
        }
    return half;
}

std::uint64_t count_texels(const std::vector<RgbaImage>& images) {
    std::uint64_t count = 0;
    for (const RgbaImage& image : images)
        count += image.texels.size();
    return count;
}

// Images by index; empty ones are not there.
std::vector<RgbaImage> decode_images(const std::vector<ImageFile>& files, Scene& scene) {
    std::vector<RgbaImage> images(files.size());
    std::size_t halved = 0;
    std::uint64_t decoded = 0;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const ImageFile& file = files[i];
        std::string problem = file.problem;
        try {
            if (!file.bytes.empty())
                images[i] = decode_image(file.bytes);
        } catch (const Error& error) {
            problem = error.what();
        }
        decoded += images[i].texels.size();
        if (decoded > MAX_DECODED_TEXELS)
            throw SceneError(scene.path.string() + ": its images hold more than " + std::to_string(MAX_DECODED_TEXELS) +
                             " pixels; scale them down");
        if (!problem.empty())
            scene.report.ignored.push_back("image " + quote_text(file.name) + ": " + problem +
                                           "; its surfaces keep their factors");
        while (count_texels(images) > MAX_TEXELS) {
            auto largest = std::max_element(images.begin(), images.end(), [](const auto& a, const auto& b) {
                return a.texels.size() < b.texels.size();
            });
            *largest = halve(*largest);
            ++halved;
        }
    }
    if (halved > 0)
        scene.report.notes.push_back("textures were halved " + std::to_string(halved) + " times to fit into " +
                                     std::to_string(MAX_TEXELS) + " texels");
    return images;
}

bool is_srgb(TextureSlot slot) {
    return slot == TextureSlot::base_color || slot == TextureSlot::emission ||
           slot == TextureSlot::translucency_color || slot == TextureSlot::gloss_color;
}

shared::Texture make_texture(const TextureUse& use, TextureSlot slot, const RgbaImage& image, std::size_t first) {
    std::uint32_t bits = 0;
    const auto set = [&](bool condition, std::uint32_t bit) { bits |= condition ? bit : 0; };
    set(use.is_nearest, shared::TEXTURE_NEAREST);
    set(use.coordinates == 1, shared::TEXTURE_SECOND_COORDINATES);
    set(is_srgb(slot), shared::TEXTURE_SRGB);
    set(use.wrap_u == TextureWrap::clamp, shared::TEXTURE_CLAMP_U);
    set(use.wrap_u == TextureWrap::mirror, shared::TEXTURE_MIRROR_U);
    set(use.wrap_v == TextureWrap::clamp, shared::TEXTURE_CLAMP_V);
    set(use.wrap_v == TextureWrap::mirror, shared::TEXTURE_MIRROR_V);
    const auto& t = use.transform;
    return {{static_cast<std::uint32_t>(first), image.width, image.height, bits},
            {t[0], t[1], t[2], 0.0f},
            {t[3], t[4], t[5], 0.0f}};
}

float& get_number(shared::MaterialPaint& paint, TextureSlot slot) {
    switch (slot) {
    case TextureSlot::transmission:
        return paint.others.x;
    case TextureSlot::translucency:
        return paint.others.z;
    case TextureSlot::translucency_color:
        return paint.others.w;
    case TextureSlot::gloss:
        return paint.layers.x;
    case TextureSlot::gloss_color:
        return paint.layers.y;
    case TextureSlot::coat:
        return paint.layers.z;
    case TextureSlot::coat_roughness:
        return paint.layers.w;
    default:
        return paint.colors[static_cast<int>(slot)];
    }
}

std::uint32_t wrap_texel(double at, std::uint32_t size, bool clamps, bool mirrors) {
    if (clamps)
        return static_cast<std::uint32_t>(std::clamp(at, 0.0, size - 1.0));
    const double period = mirrors ? 2.0 * size : size;
    const auto wrapped = static_cast<std::uint32_t>(std::min(at - period * std::floor(at / period), period - 1));
    return wrapped < size ? wrapped : 2 * size - 1 - wrapped;
}

float decode(const Scene& scene, const shared::Texture& texture, std::uint32_t code, int channel) {
    return channel < 3 && texture.place.w & shared::TEXTURE_SRGB ? std::bit_cast<float>(scene.atlas[code])
                                                                 : static_cast<float>(code) / 255.0f;
}

glm::dvec4 load_texel(const Scene& scene, const shared::Texture& texture, double column, double row) {
    const glm::uvec4& place = texture.place;
    const std::uint32_t x =
        wrap_texel(column, place.y, place.w & shared::TEXTURE_CLAMP_U, place.w & shared::TEXTURE_MIRROR_U);
    const std::uint32_t y =
        wrap_texel(row, place.z, place.w & shared::TEXTURE_CLAMP_V, place.w & shared::TEXTURE_MIRROR_V);
    const std::uint32_t codes = scene.atlas[place.x + std::size_t{y} * place.y + x];
    glm::dvec4 value;
    for (int channel = 0; channel < 4; ++channel)
        value[channel] = decode(scene, texture, get_code(codes, channel), channel);
    return value;
}

// Least and most codes of an image.
struct CodeRange {
    std::array<std::uint32_t, 4> least{255, 255, 255, 255}, most{};
};

CodeRange find_codes(const RgbaImage& image) {
    CodeRange range;
    for (const std::uint32_t texel : image.texels)
        for (int channel = 0; channel < 4; ++channel) {
            const std::uint32_t code = get_code(texel, channel);
            range.least[std::size_t(channel)] = std::min(range.least[std::size_t(channel)], code);
            range.most[std::size_t(channel)] = std::max(range.most[std::size_t(channel)], code);
        }
    return range;
}

TextureRange decode_range(const Scene& scene, const shared::Texture& texture, const CodeRange& codes) {
    TextureRange range;
    for (int channel = 0; channel < 4; ++channel) {
        range.least[std::size_t(channel)] = decode(scene, texture, codes.least[std::size_t(channel)], channel);
        range.most[std::size_t(channel)] = decode(scene, texture, codes.most[std::size_t(channel)], channel);
    }
    return range;
}

} // namespace

TextureRanges load_textures(const std::vector<MaterialTextures>& materials, const std::vector<ImageFile>& files,
                            Scene& scene) {
    const std::vector<RgbaImage> images = decode_images(files, scene);
    TextureRanges ranges(1);
    if (count_texels(images) == 0)
        return ranges;
    scene.atlas = make_srgb_table();
    std::vector<std::size_t> first(images.size());
    std::vector<CodeRange> codes(images.size());
    for (std::size_t i = 0; i < images.size(); ++i) {
        first[i] = scene.atlas.size();
        codes[i] = find_codes(images[i]);
        scene.atlas.insert(scene.atlas.end(), images[i].texels.begin(), images[i].texels.end());
    }
    for (const MaterialTextures& slots : materials) {
        shared::MaterialPaint paint{};
        paint.others.y = 1.0f;
        for (std::size_t i = 0; i < TEXTURE_SLOT_COUNT; ++i) {
            if (!slots[i] || images[slots[i]->image].texels.empty())
                continue;
            const auto slot = static_cast<TextureSlot>(i);
            const TextureUse& use = *slots[i];
            scene.textures.push_back(make_texture(use, slot, images[use.image], first[use.image]));
            ranges.push_back(decode_range(scene, scene.textures.back(), codes[use.image]));
            get_number(paint, slot) = static_cast<float>(scene.textures.size());
            if (slot == TextureSlot::normal)
                paint.others.y = static_cast<float>(use.scale);
        }
        scene.paints.push_back(paint);
    }
    return ranges;
}

glm::dvec4 sample_texture(const Scene& scene, float number, std::uint32_t triangle, const glm::dvec3& weights) {
    const shared::Texture& texture = scene.textures[static_cast<std::size_t>(number) - 1];
    const shared::CornerCoordinates& corners = scene.corner_coordinates[triangle];
    const glm::dvec4 coordinates =
        weights.x * glm::dvec4(corners.c0) + weights.y * glm::dvec4(corners.c1) + weights.z * glm::dvec4(corners.c2);
    const bool is_second = texture.place.w & shared::TEXTURE_SECOND_COORDINATES;
    const glm::dvec3 uv(is_second ? coordinates.z : coordinates.x, is_second ? coordinates.w : coordinates.y, 1.0);
    const double x = glm::dot(glm::dvec3(texture.to_u), uv) * texture.place.y;
    const double y = glm::dot(glm::dvec3(texture.to_v), uv) * texture.place.z;
    if (texture.place.w & shared::TEXTURE_NEAREST)
        return load_texel(scene, texture, std::floor(x), std::floor(y));
    const double column = std::floor(x - 0.5), row = std::floor(y - 0.5);
    const double right = x - 0.5 - column, down = y - 0.5 - row;
    const auto blend = [&](double at) {
        return glm::mix(load_texel(scene, texture, column, at), load_texel(scene, texture, column + 1, at), right);
    };
    return glm::mix(blend(row), blend(row + 1), down);
}

} // namespace photonloupe
