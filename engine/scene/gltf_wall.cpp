// SPDX-License-Identifier: Apache-2.0
// Runs the checks in order and writes the approved document.
#include "scene/gltf_wall.h"

#include <algorithm>
#include <memory>

#define XXH_INLINE_ALL
#include <nlohmann/json.hpp>
#include <xxhash.h>

#include "scene/gltf_container.h"
#include "scene/gltf_ignored.h"
#include "scene/gltf_materials.h"
#include "scene/gltf_meshes.h"
#include "scene/gltf_nodes.h"
#include "scene/gltf_skins.h"
#include "scene/limits.h"

namespace photonloupe {
namespace {

void check_version(const JsonPlace& root) {
    const JsonPlace asset = require_member(root, "asset");
    const JsonPlace version = find_member(asset, "version");
    const std::string text = read_string_or(version, "1.0"); // glTF 1 may leave it out
    if (text.starts_with("1."))
        refuse(version, "glTF version " + quote_text(text), GLTF_1_REMEDY);
    if (!text.starts_with("2."))
        refuse(version, "glTF version " + quote_text(text), "only glTF 2 is read: export it again");
    const std::string minimum = read_string_or(find_member(asset, "minVersion"), "2.0");
    if (minimum != "2.0")
        refuse(find_member(asset, "minVersion"), "it needs glTF " + quote_text(minimum), "export it as glTF 2.0");
}

void check_required_extensions(const JsonPlace& root) {
    const JsonPlace required = find_member(root, "extensionsRequired");
    for (std::size_t i = 0; i < count_elements(required, MAX_ENTRIES); ++i) {
        const JsonPlace place = get_element(required, i);
        const std::string name = read_string(place);
        if (!is_known_extension(name) && !is_dispensable_extension(name))
            refuse(place, "the required extension " + quote_text(name) + " is not supported", "export it without");
    }
}

std::string hash_content(std::string_view json, const BufferBytes& buffers, const std::vector<ImageFile>& images) {
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
    XXH3_128bits_reset(state.get());
    XXH3_128bits_update(state.get(), json.data(), json.size());
    for (const auto& buffer : buffers)
        XXH3_128bits_update(state.get(), buffer.data(), buffer.size());
    for (const ImageFile& image : images) {
        const std::uint64_t size = image.bytes.size(); // the same bytes of another image are another scene
        XXH3_128bits_update(state.get(), &size, sizeof size);
        XXH3_128bits_update(state.get(), image.bytes.data(), image.bytes.size());
    }
    XXH128_canonical_t canonical;
    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state.get()));
    constexpr std::string_view DIGITS = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : canonical.digest) {
        text += DIGITS[byte >> 4];
        text += DIGITS[byte & 15];
    }
    return text;
}

} // namespace

ApprovedGltf approve_gltf(std::span<const unsigned char> bytes, const std::filesystem::path& folder,
                          const std::string& name, bool is_animated) {
    const JsonPlace file{nullptr, "", &name};
    const GltfContainer container = split_container(bytes, file);
    const Json document = parse_json(container.json, file);
    const JsonPlace root{&document, "", &name};
    check_version(root);
    check_required_extensions(root);

    ApprovedGltf result;
    Json approved{{"asset", {{"version", "2.0"}}}};
    result.ignored = list_ignored_features(root, is_animated);
    result.buffers = read_buffers(root, folder, container.binary_chunk);
    AccessorTable accessors(root, result.buffers);
    check_materials(root, approved);
    result.textures = check_textures(root, result.ignored);
    result.images = read_images(root, folder, accessors, result.textures);
    result.hash = hash_content(container.json, result.buffers, result.images);
    NodeTargets targets;
    targets.mesh_count = count_elements(find_member(root, "meshes"), MAX_ENTRIES);
    targets.skin_count = count_elements(find_member(root, "skins"), MAX_ENTRIES);
    targets.camera_count = check_cameras(root, approved);
    targets.light_count = check_lights(root, approved);
    const std::vector<std::uint64_t> draw_counts = check_nodes(root, targets, accessors, approved, result.ignored);
    check_skins(root, accessors, approved);
    check_meshes(root, draw_counts, accessors, approved, result.ignored);
    if (is_animated)
        result.animation = check_animations(root, accessors, approved, result.ignored);
    result.columns = accessors.take_columns();
    result.json = approved.dump();
    return result;
}

} // namespace photonloupe
