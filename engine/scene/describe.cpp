// SPDX-License-Identifier: Apache-2.0
// describe_scene: what a scene holds, in a page of text.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <sstream>

#include "scene/scene.h"

namespace photonloupe {
namespace {

// Enough to recognize a value; the arrays hold the exact ones.
constexpr int DIGITS = 6;

template <class Vector>
std::string format_vector(const Vector& v, double factor = 1.0) {
    std::ostringstream text;
    text << std::setprecision(DIGITS) << "(" << v[0] * factor << ", " << v[1] * factor << ", " << v[2] * factor << ")";
    return text.str();
}

std::string describe_material(const shared::Material& material) {
    std::ostringstream text;
    const float metallic = material.base_color_metallic.w;
    const float transmission = material.emission_transmission.w;
    const float clear = (1 - metallic) * transmission;
    const float diffuse = (1 - metallic) * (1 - transmission);
    const char* separator = "";
    const auto add = [&](float weight, const char* name) {
        if (weight <= 0)
            return;
        text << separator;
        if (weight < 1)
            text << std::setprecision(3) << weight * 100 << " % ";
        text << name;
        separator = " + ";
    };
    const bool is_rough = material.roughness_thin.x > 0, is_thin = material.roughness_thin.y != 0;
    add(metallic, is_rough ? "rough metal" : "mirror");
    add(clear, is_thin ? (is_rough ? "thin rough glass" : "thin glass") : is_rough ? "rough glass" : "glass");
    add(diffuse, "Lambert");
    if (is_rough && metallic + clear > 0)
        text << ", roughness " << material.roughness_thin.x;
    text << ", color " << format_vector(material.base_color_metallic);
    if (clear > 0 && material.roughness_thin.y == 0)
        text << ", ior " << material.absorption_ior.w << ", absorption " << format_vector(material.absorption_ior)
             << " 1/m";
    if (scatters(material))
        text << ", scattering " << format_vector(material.medium) << " 1/m, anisotropy " << material.medium.w;
    if (material.emission_transmission.x + material.emission_transmission.y + material.emission_transmission.z > 0)
        text << ", emits " << format_vector(material.emission_transmission) << " W/(m² sr)";
    if (diffuse > 0 && material.translucency.w > 0)
        text << ", passes " << material.translucency.w * 100 << " % of diffuse light, "
             << format_vector(material.translucency);
    if (diffuse > 0 && has_gloss(material))
        text << ", gloss " << format_vector(material.gloss);
    if (material.coat.x > 0)
        text << ", coat " << material.coat.x << " of roughness " << material.coat.y;
    if (clear > 0 && material.alpha.w > 0)
        text << ", Abbe number " << 20 / material.alpha.w;
    if (material.alpha.y == shared::ALPHA_MASK)
        text << ", masked below alpha " << material.alpha.z;
    if (material.alpha.y == shared::ALPHA_BLEND)
        text << ", alpha " << material.alpha.x;
    return text.str();
}

double to_degrees(double angle) {
    return angle * 180 / std::numbers::pi;
}

std::string describe_light(const shared::Light& light) {
    std::ostringstream text;
    text << std::setprecision(DIGITS) << name_kind(light) << " light, ";
    switch (find_kind(light)) {
    case shared::LIGHT_SPOT:
        text << format_vector(light.intensity) << " W/sr within " << to_degrees(find_cone_angle(light.cone.x))
             << "° to " << to_degrees(find_cone_angle(light.cone.y)) << "°";
        break;
    case shared::LIGHT_DIRECTIONAL:
        text << format_vector(light.intensity) << " W/m² along " << format_vector(light.direction);
        break;
    case shared::LIGHT_AREA:
        text << format_vector(light.intensity, std::numbers::pi * light.cone.x * light.cone.w) << " W from "
             << light.cone.x << " m²" << (light.cone.w > 1 ? ", both sides" : "");
        break;
    case shared::LIGHT_ENVIRONMENT:
        text << format_vector(light.intensity) << " W/(m² sr) from all around"
             << (has_image(light) ? ", the mean of an image" : "");
        break;
    default:
        text << format_vector(light.intensity, 4 * std::numbers::pi) << " W";
    }
    return text.str();
}

std::string join(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names)
        text += (text.empty() ? "" : ", ") + name;
    return text.empty() ? "nothing" : text;
}

void list_lines(std::ostringstream& text, const char* title, const std::vector<std::string>& lines) {
    if (lines.empty())
        return;
    text << title << "\n";
    for (const std::string& line : lines)
        text << "  " << line << "\n";
}

} // namespace

float find_cap(double angle) {
    return static_cast<float>(2 * std::pow(std::sin(0.5 * angle), 2));
}

double find_cone_angle(float cap) {
    return 2 * std::asin(std::sqrt(0.5 * static_cast<double>(cap)));
}

std::string count_lights(const Scene& scene) {
    std::vector<std::string> counts;
    for (const char* kind : {"point", "spot", "directional", "area", "environment"}) {
        const auto count = std::count_if(scene.lights.begin(), scene.lights.end(), [&](const shared::Light& light) {
            return std::string_view(name_kind(light)) == kind;
        });
        if (count > 0)
            counts.push_back(std::to_string(count) + " " + kind + (count == 1 ? " light" : " lights"));
    }
    std::string text;
    for (std::size_t i = 0; i < counts.size(); ++i)
        text += (i == 0 ? "" : i + 1 == counts.size() ? " and " : ", ") + counts[i];
    return text;
}

const char* name_kind(const shared::Light& light) {
    constexpr const char* NAMES[] = {"point", "spot", "directional", "area", "environment"};
    return NAMES[find_kind(light)];
}

SceneFeatures list_features(const Scene& scene) {
    const SceneReport& report = scene.report;
    const std::pair<bool, const char*> features[] = {{report.has_diffuse, "Lambert"},
                                                     {report.has_mirror, "mirrors"},
                                                     {report.has_dielectric, "dielectrics"},
                                                     {report.has_rough, "roughness"},
                                                     {report.has_absorption, "absorption"},
                                                     {report.has_thin, "thin glass"},
                                                     {!scene.textures.empty(), "textures"},
                                                     {!scene.corner_colors.empty(), "vertex colors"},
                                                     {report.has_alpha, "alpha"},
                                                     {report.has_translucency, "translucency"},
                                                     {report.has_layers, "gloss and coats"},
                                                     {report.has_dispersion, "dispersion"},
                                                     {report.has_media, "participating media"},
                                                     {report.has_emission, "emission seen by cameras"}};
    SceneFeatures result;
    for (const auto& [present, name] : features)
        (present ? result.required : result.left_out).emplace_back(name);
    return result;
}

std::string describe_scene(const Scene& scene) {
    std::ostringstream text;
    text << std::setprecision(DIGITS);
    text << "scene " << scene.path.string() << " (" << scene.hash << ")\n"
         << scene.triangles.size() << " triangles in " << scene.objects.size() << " objects, " << scene.nodes.size()
         << " BVH nodes\n"
         << "bounds " << format_vector(scene.bounds.lo) << " … " << format_vector(scene.bounds.hi) << " m";
    if (scene.origin != std::array<double, 3>{})
        text << ", computed relative to " << format_vector(scene.origin);
    text << "\n" << scene.lights.size() << (scene.lights.size() == 1 ? " light\n" : " lights\n");
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        text << "  " << scene.light_names[i] << ": " << describe_light(scene.lights[i]) << "\n";
    text << scene.cameras.size() << (scene.cameras.size() == 1 ? " camera\n" : " cameras\n");
    for (const Camera& camera : scene.cameras)
        text << "  " << camera.name << ": at " << format_vector(camera.position) << ", " << to_degrees(camera.yfov)
             << "° high\n";
    text << scene.materials.size() << (scene.materials.size() == 1 ? " material\n" : " materials\n");
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        text << "  " << scene.material_names[i] << ": " << describe_material(scene.materials[i]) << "\n";
    const SceneFeatures features = list_features(scene);
    text << "required: " << join(features.required) << "\nleft out: " << join(features.left_out) << "\n";
    list_lines(text, "ignored:", scene.report.ignored);
    list_lines(text, "notes:", scene.report.notes);
    return text.str();
}

} // namespace photonloupe
