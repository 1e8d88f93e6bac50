// SPDX-License-Identifier: Apache-2.0
// Finds unknown extensions and what else of glTF is left out.
#include "scene/gltf_ignored.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr std::array<std::string_view, 16> KNOWN_EXTENSIONS{"KHR_lights_punctual",
                                                            "KHR_materials_transmission",
                                                            "KHR_materials_volume",
                                                            "KHR_materials_ior",
                                                            "KHR_materials_emissive_strength",
                                                            "KHR_mesh_quantization",
                                                            "KHR_draco_mesh_compression",
                                                            "EXT_meshopt_compression",
                                                            "EXT_mesh_gpu_instancing",
                                                            "KHR_texture_transform",
                                                            "EXT_texture_webp",
                                                            "KHR_materials_diffuse_transmission",
                                                            "KHR_materials_specular",
                                                            "KHR_materials_clearcoat",
                                                            "KHR_materials_dispersion",
                                                            "KHR_materials_volume_scatter"};

// Parts of names: what follows the vendor's letters in "KHR_materials_unlit" or "EXT_texture_webp".
constexpr std::array<std::string_view, 6> DISPENSABLE_KINDS{"_materials_", "_texture_", "_lights_",
                                                            "_animation_", "_xmp",      "_audio"};

// Members that are listed wherever they stand; the text is what the user reads.
const std::map<std::string_view, const char*>& get_member_features() {
    static const std::map<std::string_view, const char*> features{
        {"occlusionTexture", "occlusion textures"},
        {"thicknessTexture", "thickness textures"},
        {"clearcoatNormalTexture", "normal textures of clear coats"},
        {"orthographic", "orthographic cameras"},
        {"range", "the range of lights (light reaches everywhere)"},
    };
    return features;
}

// Counts features by name; walks everything but `extras`. The depth is bounded by MAX_JSON_DEPTH.
void count_features(const Json& value, std::map<std::string, std::size_t>& counts) {
    if (value.is_array())
        for (const Json& element : value)
            count_features(element, counts);
    if (!value.is_object())
        return;
    for (const auto& [key, member] : value.items()) {
        if (key == "extras" || key == "animations")
            continue;
        if (const auto feature = get_member_features().find(key); feature != get_member_features().end())
            ++counts[feature->second];
        if (key == "extensions" && member.is_object())
            for (const auto& [name, extension] : member.items())
                if (!is_known_extension(name))
                    ++counts["extension " + quote_text(name)];
        count_features(member, counts);
    }
}

void count_used_extensions(const JsonPlace& root, std::map<std::string, std::size_t>& counts) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        const JsonPlace names = find_member(root, list);
        for (std::size_t i = 0; i < count_elements(names, MAX_ENTRIES); ++i) {
            const std::string name = read_string(get_element(names, i));
            if (!is_known_extension(name))
                counts.try_emplace("extension " + quote_text(name), 0);
        }
    }
}

} // namespace

bool is_known_extension(std::string_view name) {
    return std::find(KNOWN_EXTENSIONS.begin(), KNOWN_EXTENSIONS.end(), name) != KNOWN_EXTENSIONS.end();
}

bool is_dispensable_extension(std::string_view name) {
    return std::any_of(DISPENSABLE_KINDS.begin(), DISPENSABLE_KINDS.end(),
                       [name](std::string_view kind) { return name.find(kind) != name.npos; });
}

std::vector<std::string> list_ignored_features(const JsonPlace& root, bool is_animated) {
    std::map<std::string, std::size_t> counts;
    count_features(*root.value, counts);
    count_used_extensions(root, counts);
    std::vector<std::string> ignored;
    for (const auto& [feature, count] : counts)
        ignored.push_back(feature + (count > 1 ? " (" + std::to_string(count) + ")" : "") + ": not modeled");
    if (count_elements(find_member(root, "animations"), MAX_ENTRIES) > 0 && !is_animated)
        ignored.emplace_back("animations: everything is at rest; a time, as --time gives it, poses it");
    return ignored;
}

} // namespace photonloupe
