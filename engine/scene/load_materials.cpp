// SPDX-License-Identifier: Apache-2.0
// Material factors after METHODS section 0 and what they leave unmodeled.
#include "scene/load_materials.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

#include "core/error.h"
#include "core/json_place.h"
#include "scene/load_textures.h"

namespace photonloupe {
namespace {

// -ln 0 is infinite: an attenuation color of 0 is read as the smallest normal float (87 mean free paths).
constexpr double MIN_TRANSMITTANCE = std::numeric_limits<float>::min();

// Member of an extension as a number; the wall has filled in every default that matters.
double read_extension_number(const tinygltf::Material& material, const char* extension, const char* key,
                             double fallback) {
    const auto found = material.extensions.find(extension);
    if (found == material.extensions.end() || !found->second.Has(key))
        return fallback;
    return found->second.Get(key).GetNumberAsDouble();
}

// Albedo of one scattering whose repetition in a half space gives this color (Kulla and Conty 2017).
double find_single_albedo(double color) {
    const double root = 4.09712 + 4.20863 * color - std::sqrt(9.59217 + 41.6808 * color + 17.7126 * color * color);
    return std::clamp(1 - root * root, 0.0, 1.0);
}

// Beer-Lambert coefficients in 1/m: the color is what is left after the distance.
glm::vec3 compute_absorption(const tinygltf::Material& material, const std::string& scene_name) {
    const double distance = read_extension_number(material, "KHR_materials_volume", "attenuationDistance",
                                                  std::numeric_limits<double>::infinity());
    glm::vec3 absorption(0.0f);
    if (!std::isfinite(distance))
        return absorption;
    const tinygltf::Value& color = material.extensions.at("KHR_materials_volume").Get("attenuationColor");
    for (int i = 0; i < 3; ++i) {
        const double channel = std::max(color.Get(i).GetNumberAsDouble(), MIN_TRANSMITTANCE);
        absorption[i] = float(std::max(0.0, -std::log(channel) / distance));
        if (!std::isfinite(absorption[i]))
            throw SceneError(scene_name + ": material " + quote_text(material.name) +
                             ": its attenuationDistance is too small for 32-bit floats; make it longer");
    }
    return absorption;
}

glm::vec3 read_extension_color(const tinygltf::Material& material, const char* extension, const char* key) {
    const auto found = material.extensions.find(extension);
    if (found == material.extensions.end() || !found->second.Has(key))
        return glm::vec3(1.0f);
    const tinygltf::Value& color = found->second.Get(key);
    return {color.Get(0).GetNumberAsDouble(), color.Get(1).GetNumberAsDouble(), color.Get(2).GetNumberAsDouble()};
}

// A medium's scattering coefficients and anisotropy; what KHR_materials_volume_scatter scatters is taken from what
// the volume was said to absorb. `absorption` in 1/m.
glm::vec4 compute_medium(const tinygltf::Material& material, glm::vec3& absorption) {
    constexpr const char* OWN = "photonloupe";
    constexpr const char* KHRONOS = "KHR_materials_volume_scatter";
    if (material.extensions.contains(OWN))
        return {read_extension_color(material, OWN, "scattering"),
                float(read_extension_number(material, OWN, "anisotropy", 0.0))};
    if (!material.extensions.contains(KHRONOS))
        return glm::vec4(0.0f);
    const glm::vec3 color = read_extension_color(material, KHRONOS, "multiscatterColor");
    const glm::vec3 extinction = absorption;
    glm::vec4 medium(0.0f, 0.0f, 0.0f, float(read_extension_number(material, KHRONOS, "scatterAnisotropy", 0.0)));
    for (int i = 0; i < 3; ++i) {
        medium[i] = extinction[i] * float(find_single_albedo(color[i]));
        absorption[i] = extinction[i] - medium[i];
    }
    return medium;
}

// KHR_materials_specular: reflectance straight on and at grazing angles. Without the extension none is modeled.
glm::vec4 compute_gloss(const tinygltf::Material& material, double ior) {
    constexpr const char* EXTENSION = "KHR_materials_specular";
    if (!material.extensions.contains(EXTENSION))
        return glm::vec4(0.0f);
    const auto factor = float(read_extension_number(material, EXTENSION, "specularFactor", 1.0));
    const auto straight = float(std::pow((ior - 1) / (ior + 1), 2));
    return {glm::min(straight * read_extension_color(material, EXTENSION, "specularColorFactor"), 1.0f) * factor,
            factor};
}

shared::Material convert_material(const tinygltf::Material& material, const std::string& scene_name) {
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    const double transmission =
        read_extension_number(material, "KHR_materials_transmission", "transmissionFactor", 0.0);
    const double thickness = read_extension_number(material, "KHR_materials_volume", "thicknessFactor", 0.0);
    const double strength = read_extension_number(material, "KHR_materials_emissive_strength", "emissiveStrength", 1.0);
    const bool is_thin = transmission > 0 && thickness == 0;
    const bool has_inside = transmission > 0 && thickness > 0;
    glm::vec3 absorption = has_inside ? compute_absorption(material, scene_name) : glm::vec3(0.0f);
    shared::Material result{};
    if (has_inside)
        result.medium = compute_medium(material, absorption);
    for (int i = 0; i < 3; ++i) {
        result.base_color_metallic[i] = float(pbr.baseColorFactor[std::size_t(i)]);
        result.emission_transmission[i] = float(material.emissiveFactor[std::size_t(i)] * strength);
    }
    result.base_color_metallic.w = float(pbr.metallicFactor);
    result.absorption_ior = {absorption, float(read_extension_number(material, "KHR_materials_ior", "ior", 1.5))};
    result.emission_transmission.w = float(transmission);
    const float mode = material.alphaMode == "MASK"    ? shared::ALPHA_MASK
                       : material.alphaMode == "BLEND" ? shared::ALPHA_BLEND
                                                       : shared::ALPHA_OPAQUE;
    result.alpha = {float(pbr.baseColorFactor[3]), mode, float(material.alphaCutoff),
                    float(read_extension_number(material, "KHR_materials_dispersion", "dispersion", 0.0))};
    constexpr const char* TRANSLUCENT = "KHR_materials_diffuse_transmission";
    result.translucency = {read_extension_color(material, TRANSLUCENT, "diffuseTransmissionColorFactor"),
                           float(read_extension_number(material, TRANSLUCENT, "diffuseTransmissionFactor", 0.0))};
    result.gloss = compute_gloss(material, result.absorption_ior.w);
    constexpr const char* COATED = "KHR_materials_clearcoat";
    result.coat = {float(read_extension_number(material, COATED, "clearcoatFactor", 0.0)),
                   float(read_extension_number(material, COATED, "clearcoatRoughnessFactor", 0.0)), 0.0f, 0.0f};
    result.roughness_thin = {float(pbr.roughnessFactor), is_thin ? 1.0f : 0.0f, material.doubleSided ? 1.0f : 0.0f,
                             0.0f};
    // Nothing turns light where the index does not change, however rough the border is.
    if (scatters(result) && result.absorption_ior.w == 1.0f && transmission == 1 && result.base_color_metallic.w == 0)
        result.roughness_thin.x = 0.0f;
    return result;
}

shared::Material make_default_material() {
    shared::Material material{};
    material.base_color_metallic = {1.0f, 1.0f, 1.0f, 1.0f};
    material.absorption_ior = {0.0f, 0.0f, 0.0f, 1.5f};
    material.roughness_thin = {1.0f, 0.0f, 0.0f, 0.0f};
    material.alpha = {1.0f, shared::ALPHA_OPAQUE, 0.0f, 0.0f};
    return material;
}

// Clears factors of which textures leave nothing anywhere, and returns what they leave at least of the others.
shared::Material fold_textures(Scene& scene, const TextureRanges& ranges, std::size_t index) {
    shared::Material& material = scene.materials[index];
    if (scene.paints.empty())
        return material;
    const shared::MaterialPaint& paint = scene.paints[index];
    const auto find_range = [&](float number) { return ranges[static_cast<std::size_t>(number)]; };
    const TextureRange color = find_range(paint.colors.x);
    const TextureRange shine = find_range(paint.colors.y);
    const TextureRange emission = find_range(paint.colors.w);
    const TextureRange transmission = find_range(paint.others.x);
    const auto clear = [](float& factor, float most) { factor = most > 0 ? factor : 0.0f; };
    clear(material.base_color_metallic.w, shine.most[2]);
    clear(material.roughness_thin.x, shine.most[1]);
    clear(material.emission_transmission.w, transmission.most[0]);
    for (int channel = 0; channel < 3; ++channel)
        clear(material.emission_transmission[channel], emission.most[std::size_t(channel)]);
    clear(material.translucency.w, find_range(paint.others.z).most[3]);
    clear(material.coat.x, find_range(paint.layers.z).most[0]);
    if (find_range(paint.layers.x).most[3] == 0)
        material.gloss = glm::vec4(0.0f);
    shared::Material least = material;
    least.base_color_metallic.w *= shine.least[2];
    least.emission_transmission.w *= transmission.least[0];
    least.alpha.x *= color.least[3];
    return least;
}

// The least alpha of vertex colors.
float find_vertex_alpha(const Scene& scene) {
    float least = 1.0f;
    for (const shared::CornerColors& colors : scene.corner_colors)
        least = std::min({least, colors.c0.w, colors.c1.w, colors.c2.w});
    return least;
}

// A surface whose alpha makes no difference is opaque.
void simplify_alpha(shared::Material& material, float least) {
    const bool differs = material.alpha.y == shared::ALPHA_MASK ? least < material.alpha.z : least < 1;
    if (!differs)
        material.alpha.y = shared::ALPHA_OPAQUE;
}

std::vector<bool> find_used_materials(const Scene& scene) {
    std::vector<bool> used(scene.materials.size(), false);
    for (const SceneObject& object : scene.objects)
        if (object.triangle_count > 0)
            used[object.material] = true;
    return used;
}

} // namespace

void report_material(const shared::Material& material, const shared::Material& least, const std::string& label,
                     SceneReport& report) {
    const float metallic = material.base_color_metallic.w;
    const float transmission = material.emission_transmission.w;
    const float roughness = material.roughness_thin.x;
    const bool is_thin = material.roughness_thin.y != 0.0f;
    const float least_metallic = least.base_color_metallic.w, least_transmission = least.emission_transmission.w;
    const bool is_clear = least_metallic < 1 && transmission > 0;
    const bool is_diffuse = least_metallic < 1 && least_transmission < 1;
    const bool is_glossy = is_diffuse && has_gloss(material), is_coated = material.coat.x > 0;
    const bool absorbs =
        std::max({material.absorption_ior.x, material.absorption_ior.y, material.absorption_ior.z}) > 0;
    const glm::vec3 emission(material.emission_transmission);
    const bool emits = std::max({emission.x, emission.y, emission.z}) > 0;

    report.has_mirror |= metallic > 0;
    report.has_rough |=
        (roughness > 0 && (metallic > 0 || is_clear || is_glossy)) || (is_coated && material.coat.y > 0);
    report.has_dielectric |= is_clear && !is_thin;
    report.has_thin |= is_clear && is_thin;
    report.has_absorption |= is_clear && !is_thin && absorbs;
    report.has_diffuse |= is_diffuse;
    report.has_layers |= is_glossy || is_coated;
    report.has_translucency |= is_diffuse && material.translucency.w > 0;
    report.has_media |= scatters(material);
    report.has_dispersion |= is_clear && !is_thin && material.alpha.w > 0;
    report.has_mixed_receiver |= is_diffuse && (metallic > 0 || transmission > 0 || is_glossy || is_coated);
    report.has_alpha |= material.alpha.y != shared::ALPHA_OPAQUE;
    report.has_emission |= emits;

    if (is_diffuse && !is_glossy)
        report.ignored.push_back(label + ": the specular lobe of its opaque, non-metal part is not modeled (Lambert)");
}

void load_materials(const tinygltf::Model& model, const TextureRanges& ranges, Scene& scene) {
    const std::string scene_name = scene.path.string();
    for (std::size_t i = 0; i < model.materials.size(); ++i) {
        const tinygltf::Material& material = model.materials[i];
        scene.materials.push_back(convert_material(material, scene_name));
        scene.material_names.push_back(material.name.empty() ? "material " + std::to_string(i) : material.name);
        if (material.extensions.contains("KHR_materials_volume_scatter") && !is_solid(scene.materials.back()))
            scene.report.ignored.push_back("material " + quote_text(scene.material_names.back()) +
                                           ": KHR_materials_volume_scatter is modeled only with transmission and a "
                                           "thickness");
    }
    const bool needs_default = std::any_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& object) {
        return object.material == model.materials.size();
    });
    if (needs_default) {
        scene.materials.push_back(make_default_material());
        scene.material_names.push_back("glTF default");
        if (!scene.paints.empty())
            scene.paints.emplace_back();
    }
    const std::vector<bool> used = find_used_materials(scene);
    const float vertex_alpha = find_vertex_alpha(scene);
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i]) {
            const shared::Material least = fold_textures(scene, ranges, i);
            const std::string label = "material " + quote_text(scene.material_names[i]);
            if (scene.materials[i].alpha.y != shared::ALPHA_OPAQUE && scene.materials[i].emission_transmission.w > 0) {
                scene.materials[i].alpha.y = shared::ALPHA_OPAQUE;
                scene.report.ignored.push_back(label + ": alpha of what transmits is not modeled");
            }
            simplify_alpha(scene.materials[i], least.alpha.x * vertex_alpha);
            report_material(scene.materials[i], least, "material " + quote_text(scene.material_names[i]), scene.report);
        }
}

} // namespace photonloupe
