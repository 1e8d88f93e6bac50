// SPDX-License-Identifier: Apache-2.0
// Finds textures, skins, animations, unknown extensions and the rest of glTF that is left out.
#include "scene/gltf_ignored.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr std::array<std::string_view, 8> KNOWN_EXTENSIONS{"KHR_lights_punctual",
                                                           "KHR_materials_transmission",
                                                           "KHR_materials_volume",
                                                           "KHR_materials_ior",
                                                           "KHR_materials_emissive_strength",
                                                           "KHR_mesh_quantization",
                                                           "KHR_texture_transform",
                                                           "EXT_texture_webp"};

// Members that are listed wherever they stand; the text is what the user reads.
const std::map<std::string_view, const char*>& get_member_features() {
    static const std::map<std::string_view, const char*> features{
        {"occlusionTexture", "occlusion textures"},
        {"thicknessTexture", "thickness textures"},
        {"targets", "morph targets"},
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
    const JsonPlace used = find_member(root, "extensionsUsed");
    for (std::size_t i = 0; i < count_elements(used, MAX_ENTRIES); ++i) {
        const std::string name = read_string(get_element(used, i));
        if (!is_known_extension(name))
            counts.try_emplace("extension " + quote_text(name), 0);
    }
}

} // namespace

bool is_known_extension(std::string_view name) {
    return std::find(KNOWN_EXTENSIONS.begin(), KNOWN_EXTENSIONS.end(), name) != KNOWN_EXTENSIONS.end();
}

std::vector<std::string> list_ignored_features(const JsonPlace& root) {
    std::map<std::string, std::size_t> counts;
    count_features(*root.value, counts);
    count_used_extensions(root, counts);
    for (const char* section : {"skins", "animations"})
        if (const std::size_t count = count_elements(find_member(root, section), MAX_ENTRIES))
            counts[section] = count;
    std::vector<std::string> ignored;
    for (const auto& [feature, count] : counts)
        ignored.push_back(feature + (count > 1 ? " (" + std::to_string(count) + ")" : "") + ": not modeled");
    return ignored;
}

} // namespace photonloupe
