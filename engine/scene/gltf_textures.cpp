// SPDX-License-Identifier: Apache-2.0
// Texture references, samplers, transforms and images. What is broken in the file's structure is refused; an image that
// can't be had only leaves its surfaces to their factors.
#include "scene/gltf_textures.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "scene/gltf_container.h"
#include "scene/gltf_uri.h"
#include "scene/limits.h"

namespace photonloupe {
namespace {

// glTF 2.0, section 5.26.
constexpr std::uint64_t NEAREST = 9728, CLAMP = 33071, MIRROR = 33648, REPEAT = 10497, LARGEST_SAMPLER_VALUE = 65535;
constexpr std::uint64_t TEXCOORD_SETS = 2;
constexpr NumberRange FINITE{-1e6, 1e6};

struct SlotPlace {
    const char* owner; // "": the material itself
    const char* member;
};
constexpr std::array<SlotPlace, TEXTURE_SLOT_COUNT> SLOTS{
    {{"pbrMetallicRoughness", "baseColorTexture"},
     {"pbrMetallicRoughness", "metallicRoughnessTexture"},
     {"", "normalTexture"},
     {"", "emissiveTexture"},
     {"KHR_materials_transmission", "transmissionTexture"},
     {"KHR_materials_diffuse_transmission", "diffuseTransmissionTexture"},
     {"KHR_materials_diffuse_transmission", "diffuseTransmissionColorTexture"},
     {"KHR_materials_specular", "specularTexture"},
     {"KHR_materials_specular", "specularColorTexture"},
     {"KHR_materials_clearcoat", "clearcoatTexture"},
     {"KHR_materials_clearcoat", "clearcoatRoughnessTexture"}}};

JsonPlace find_slot(const JsonPlace& material, const SlotPlace& slot) {
    const std::string_view owner(slot.owner);
    if (owner.empty())
        return find_member(material, slot.member);
    return find_member(owner.starts_with("KHR_") ? find_extension(material, slot.owner)
                                                 : find_member(material, slot.owner),
                       slot.member);
}

TextureWrap read_wrap(const JsonPlace& sampler, const char* member) {
    const JsonPlace place = find_member(sampler, member);
    switch (read_unsigned_or(place, LARGEST_SAMPLER_VALUE, REPEAT)) {
    case CLAMP:
        return TextureWrap::clamp;
    case MIRROR:
        return TextureWrap::mirror;
    case REPEAT:
        return TextureWrap::repeat;
    default:
        refuse(place, "it is no way to wrap a texture", "use 33071, 33648 or 10497");
    }
}

void read_sampler(const JsonPlace& root, const JsonPlace& texture, TextureUse& use) {
    const JsonPlace samplers = find_member(root, "samplers");
    const auto index = read_index(find_member(texture, "sampler"), count_elements(samplers, MAX_ENTRIES), "sampler");
    if (!index)
        return;
    const JsonPlace sampler = get_element(samplers, *index);
    use.wrap_u = read_wrap(sampler, "wrapS");
    use.wrap_v = read_wrap(sampler, "wrapT");
    use.is_nearest = read_unsigned_or(find_member(sampler, "magFilter"), LARGEST_SAMPLER_VALUE, 0) == NEAREST;
}

// Offset, then rotation, then scale of the coordinates, counter-clockwise as the picture is seen (v points down).
void read_transform(const JsonPlace& reference, TextureUse& use) {
    const JsonPlace transform = find_extension(reference, "KHR_texture_transform");
    if (!transform.value)
        return;
    const std::vector<double> offset = read_numbers_or(find_member(transform, "offset"), {0, 0}, FINITE);
    const std::vector<double> scale = read_numbers_or(find_member(transform, "scale"), {1, 1}, FINITE);
    const double angle = read_number_or(find_member(transform, "rotation"), 0.0, FINITE);
    const double c = std::cos(angle), s = std::sin(angle);
    use.transform = {c * scale.at(0), s * scale.at(1), offset.at(0), -s * scale.at(0), c * scale.at(1), offset.at(1)};
    use.coordinates =
        static_cast<std::uint32_t>(read_unsigned_or(find_member(transform, "texCoord"), MAX_ENTRIES, use.coordinates));
}

// The image of a format that is read; a texture may name one of another format besides.
std::optional<std::uint32_t> find_image(const JsonPlace& root, const JsonPlace& texture) {
    const std::size_t count = count_elements(find_member(root, "images"), MAX_IMAGES);
    if (const auto webp =
            read_index(find_member(find_extension(texture, "EXT_texture_webp"), "source"), count, "image"))
        return webp;
    return read_index(find_member(texture, "source"), count, "image");
}

std::optional<TextureUse> read_reference(const JsonPlace& root, const JsonPlace& reference,
                                         std::vector<std::string>& ignored) {
    if (!reference.value)
        return std::nullopt;
    const JsonPlace textures = find_member(root, "textures");
    const auto index = read_index(require_member(reference, "index"), count_elements(textures, MAX_ENTRIES), "texture");
    const JsonPlace texture = get_element(textures, *index);
    const auto image = find_image(root, texture);
    TextureUse use;
    use.coordinates = static_cast<std::uint32_t>(read_unsigned_or(find_member(reference, "texCoord"), MAX_ENTRIES, 0));
    use.scale = read_number_or(find_member(reference, "scale"), 1.0, FINITE);
    read_sampler(root, texture, use);
    read_transform(reference, use);
    if (!image) {
        ignored.push_back(reference.path + ": its texture has no PNG, JPEG or WebP image; the factors hold alone");
        return std::nullopt;
    }
    if (use.coordinates >= TEXCOORD_SETS) {
        ignored.push_back(reference.path + ": texture coordinates beyond TEXCOORD_1; the factors hold alone");
        return std::nullopt;
    }
    use.image = *image;
    return use;
}

std::vector<unsigned char> read_image(const JsonPlace& place, const std::filesystem::path& folder,
                                      AccessorTable& accessors, std::string& name) {
    const JsonPlace uri_place = find_member(place, "uri");
    if (!uri_place.value) {
        const std::span<const unsigned char> bytes = accessors.check_view_bytes(require_member(place, "bufferView"));
        return {bytes.begin(), bytes.end()};
    }
    const std::string uri = read_string(uri_place);
    if (uri.starts_with("data:"))
        return decode_image_uri(uri, uri_place);
    name = uri;
    return read_file_bytes(resolve_uri(uri, folder, uri_place), std::nullopt, MAX_IMAGE_BYTES, uri_place);
}

} // namespace

std::vector<MaterialTextures> check_textures(const JsonPlace& root, std::vector<std::string>& ignored) {
    const JsonPlace materials = find_member(root, "materials");
    std::vector<MaterialTextures> textures(count_elements(materials, MAX_ENTRIES));
    for (std::size_t i = 0; i < textures.size(); ++i)
        for (std::size_t slot = 0; slot < TEXTURE_SLOT_COUNT; ++slot)
            textures[i][slot] = read_reference(root, find_slot(get_element(materials, i), SLOTS[slot]), ignored);
    return textures;
}

std::vector<ImageFile> read_images(const JsonPlace& root, const std::filesystem::path& folder, AccessorTable& accessors,
                                   const std::vector<MaterialTextures>& textures) {
    const JsonPlace places = find_member(root, "images");
    std::vector<ImageFile> files(count_elements(places, MAX_IMAGES));
    std::vector<bool> is_used(files.size(), false);
    for (const MaterialTextures& material : textures)
        for (const auto& use : material)
            if (use)
                is_used[use->image] = true;
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (!is_used[i])
            continue;
        const JsonPlace place = get_element(places, i);
        files[i].name = place.path;
        try {
            files[i].bytes = read_image(place, folder, accessors, files[i].name);
        } catch (const SceneError& error) {
            files[i].problem = error.what();
        }
        if (files[i].bytes.empty() && files[i].problem.empty())
            files[i].problem = "it is empty";
        total += files[i].bytes.size();
        if (total > MAX_BUFFER_BYTES)
            refuse(places, "the images together exceed " + std::to_string(MAX_BUFFER_BYTES) + " bytes",
                   "scale them down");
    }
    return files;
}

} // namespace photonloupe
