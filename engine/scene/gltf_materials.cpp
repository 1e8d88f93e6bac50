// SPDX-License-Identifier: Apache-2.0
// Ranges of material factors, light intensities and camera angles.
#include "scene/gltf_materials.h"

#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "scene/gltf_container.h"
#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr NumberRange UNIT{0.0, 1.0};
// Radiances and intensities are stored as 32-bit floats and multiplied with others on the way.
constexpr NumberRange POWER{0.0, 1e30};
constexpr NumberRange NOT_NEGATIVE{0.0};
// Beyond, a field of view has no finite image plane.
constexpr double MAX_YFOV = 3.14;
constexpr double WIDEST_CONE = 0.5 * std::numbers::pi;
// Indices of refraction of real matter end near 4.
constexpr NumberRange IOR{1.0, 100.0};

// 20 over the Abbe number, which glass has between 20 and 90.
constexpr NumberRange DISPERSION{0.0, 100.0};

// 1/m: a mean free path of a nanometre is shorter than any wave of light.
constexpr NumberRange SCATTERING{0.0, 1e9};
// The mean cosine; closer to 1 nearly nothing is scattered, and floats no longer tell by how much.
constexpr NumberRange ANISOTROPY{-0.99, 0.99};

NumberRange require_positive(const JsonPlace& place, double hi) {
    if (place.value && place.value->is_number() && place.value->get<double>() <= 0)
        refuse(place, "it must be more than 0", "set it to a positive value");
    return {0.0, hi};
}

// glTF's special 0 is a perfect Fresnel reflector; the largest index reflects 96 % of what comes head-on.
double read_ior(const JsonPlace& place) {
    return place.value && *place.value == 0 ? IOR.hi : read_number_or(place, 1.5, IOR);
}

void write_volume(const JsonPlace& material, Json& extensions) {
    const JsonPlace volume = find_extension(material, "KHR_materials_volume");
    if (!volume.value)
        return;
    Json& approved = extensions["KHR_materials_volume"];
    approved["thicknessFactor"] = read_number_or(find_member(volume, "thicknessFactor"), 0.0, NOT_NEGATIVE);
    approved["attenuationColor"] = read_numbers_or(find_member(volume, "attenuationColor"), {1, 1, 1}, UNIT);
    const JsonPlace distance = find_member(volume, "attenuationDistance");
    if (distance.value)
        approved["attenuationDistance"] = read_number(distance, require_positive(distance, NumberRange{}.hi));
}

// What a medium scatters: ours, in extras, or KHR_materials_volume_scatter.
void write_medium(const JsonPlace& material, Json& extensions) {
    const JsonPlace khronos = find_extension(material, "KHR_materials_volume_scatter");
    if (khronos.value)
        extensions["KHR_materials_volume_scatter"] = {
            {"multiscatterColor", read_numbers_or(find_member(khronos, "multiscatterColor"), {0, 0, 0}, UNIT)},
            {"scatterAnisotropy", read_number_or(find_member(khronos, "scatterAnisotropy"), 0.0, ANISOTROPY)}};
    const JsonPlace extras = find_member(material, "extras");
    if (!extras.value || !extras.value->is_object()) // other programs put there what they like
        return;
    const JsonPlace own = find_member(extras, "photonloupe");
    if (!own.value)
        return;
    const JsonPlace scattering = find_member(own, "scattering");
    for (const auto& [name, member] : own.value->items())
        if (name != "scattering" && name != "anisotropy")
            refuse(own, "no medium has " + quote_text(name), "use scattering and anisotropy");
    const std::vector<double> coefficients = read_numbers_or(scattering, {0, 0, 0}, SCATTERING);
    const bool has_inside = extensions["KHR_materials_transmission"]["transmissionFactor"] > 0 &&
                            extensions.contains("KHR_materials_volume") &&
                            extensions["KHR_materials_volume"]["thicknessFactor"] > 0;
    if (!has_inside && coefficients != std::vector<double>{0, 0, 0})
        refuse(scattering, "light scatters only inside of what it enters",
               "set KHR_materials_transmission's transmissionFactor and KHR_materials_volume's thicknessFactor");
    extensions["photonloupe"] = {{"scattering", coefficients},
                                 {"anisotropy", read_number_or(find_member(own, "anisotropy"), 0.0, ANISOTROPY)}};
}

// Members of an extension, where it is there: numbers, colors.
void write_extension(const JsonPlace& material, const char* name,
                     std::initializer_list<std::pair<const char*, double>> numbers,
                     std::initializer_list<const char*> colors, NumberRange range, Json& extensions) {
    const JsonPlace extension = find_extension(material, name);
    if (!extension.value)
        return;
    Json& approved = extensions[name];
    for (const auto& [member, fallback] : numbers)
        approved[member] = read_number_or(find_member(extension, member), fallback, UNIT);
    for (const char* member : colors)
        approved[member] = read_numbers_or(find_member(extension, member), {1, 1, 1}, range);
}

std::string check_alpha_mode(const JsonPlace& place) {
    const std::string mode = read_string_or(place, "OPAQUE");
    if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
        refuse(place, quote_text(mode) + " is no alpha mode", "use OPAQUE, MASK or BLEND");
    return mode;
}

Json check_material(const JsonPlace& place) {
    const JsonPlace pbr = find_member(place, "pbrMetallicRoughness");
    Json extensions = Json::object();
    extensions["KHR_materials_transmission"]["transmissionFactor"] = read_number_or(
        find_member(find_extension(place, "KHR_materials_transmission"), "transmissionFactor"), 0.0, UNIT);
    extensions["KHR_materials_ior"]["ior"] = read_ior(find_member(find_extension(place, "KHR_materials_ior"), "ior"));
    extensions["KHR_materials_emissive_strength"]["emissiveStrength"] = read_number_or(
        find_member(find_extension(place, "KHR_materials_emissive_strength"), "emissiveStrength"), 1.0, POWER);
    write_volume(place, extensions);
    write_medium(place, extensions);
    write_extension(place, "KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.0}},
                    {"diffuseTransmissionColorFactor"}, UNIT, extensions);
    write_extension(place, "KHR_materials_specular", {{"specularFactor", 1.0}}, {"specularColorFactor"}, POWER,
                    extensions);
    write_extension(place, "KHR_materials_clearcoat", {{"clearcoatFactor", 0.0}, {"clearcoatRoughnessFactor", 0.0}}, {},
                    UNIT, extensions);
    extensions["KHR_materials_dispersion"]["dispersion"] =
        read_number_or(find_member(find_extension(place, "KHR_materials_dispersion"), "dispersion"), 0.0, DISPERSION);
    return {{"name", read_string_or(find_member(place, "name"), "")},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", read_numbers_or(find_member(pbr, "baseColorFactor"), {1, 1, 1, 1}, UNIT)},
              {"metallicFactor", read_number_or(find_member(pbr, "metallicFactor"), 1.0, UNIT)},
              {"roughnessFactor", read_number_or(find_member(pbr, "roughnessFactor"), 1.0, UNIT)}}},
            {"emissiveFactor", read_numbers_or(find_member(place, "emissiveFactor"), {0, 0, 0}, UNIT)},
            {"alphaMode", check_alpha_mode(find_member(place, "alphaMode"))},
            {"alphaCutoff", read_number_or(find_member(place, "alphaCutoff"), 0.5, NOT_NEGATIVE)},
            {"doubleSided", read_flag_or(find_member(place, "doubleSided"), false)},
            {"extensions", std::move(extensions)}};
}

Json check_spot(const JsonPlace& place) {
    const JsonPlace inner = find_member(place, "innerConeAngle"), outer = find_member(place, "outerConeAngle");
    const double least = read_number_or(inner, 0.0, {0.0, WIDEST_CONE});
    const double most = read_number_or(outer, 0.25 * std::numbers::pi, require_positive(outer, WIDEST_CONE));
    if (least > most)
        refuse(inner, "the inner cone is wider than the outer one", "make innerConeAngle the smaller");
    return {{"innerConeAngle", least}, {"outerConeAngle", most}};
}

Json check_light(const JsonPlace& place) {
    const std::string type = read_string(require_member(place, "type"));
    if (type != "point" && type != "spot" && type != "directional")
        refuse(find_member(place, "type"), quote_text(type) + " is no kind of light", "use point, spot or directional");
    const auto color = read_numbers_or(find_member(place, "color"), {1, 1, 1}, POWER);
    const double intensity = read_number_or(find_member(place, "intensity"), 1.0, POWER);
    for (const double channel : color)
        if (channel * intensity > POWER.hi)
            refuse(place, "color times intensity is beyond the range of 32-bit floats", "lower the intensity");
    Json approved{{"name", read_string_or(find_member(place, "name"), "")},
                  {"type", type},
                  {"color", color},
                  {"intensity", intensity}};
    if (type == "spot")
        approved["spot"] = check_spot(find_member(place, "spot"));
    return approved;
}

Json check_camera(const JsonPlace& place) {
    Json approved{{"name", read_string_or(find_member(place, "name"), "")}};
    const std::string type = read_string(require_member(place, "type"));
    if (type != "perspective") {
        approved["type"] = "orthographic";
        approved["orthographic"] = {{"xmag", 1.0}, {"ymag", 1.0}, {"znear", 0.0}, {"zfar", 1.0}};
        return approved;
    }
    const JsonPlace perspective = require_member(place, "perspective");
    const JsonPlace yfov = require_member(perspective, "yfov");
    const JsonPlace aspect = find_member(perspective, "aspectRatio");
    approved["type"] = type;
    approved["perspective"] = {{"yfov", read_number(yfov, require_positive(yfov, MAX_YFOV))},
                               {"aspectRatio", read_number_or(aspect, 0.0, require_positive(aspect, 1e6))},
                               {"znear", 1.0}}; // required by the parser; the pinhole here has no near plane
    return approved;
}

} // namespace

void check_materials(const JsonPlace& root, Json& approved) {
    const JsonPlace materials = find_member(root, "materials");
    const std::size_t count = count_elements(materials, MAX_ENTRIES);
    for (std::size_t i = 0; i < count; ++i)
        approved["materials"].push_back(check_material(get_element(materials, i)));
}

std::size_t check_lights(const JsonPlace& root, Json& approved) {
    const JsonPlace lights = find_member(find_extension(root, "KHR_lights_punctual"), "lights");
    const std::size_t count = count_elements(lights, MAX_ENTRIES);
    for (std::size_t i = 0; i < count; ++i)
        approved["extensions"]["KHR_lights_punctual"]["lights"].push_back(check_light(get_element(lights, i)));
    return count;
}

std::size_t check_cameras(const JsonPlace& root, Json& approved) {
    const JsonPlace cameras = find_member(root, "cameras");
    const std::size_t count = count_elements(cameras, MAX_ENTRIES);
    for (std::size_t i = 0; i < count; ++i)
        approved["cameras"].push_back(check_camera(get_element(cameras, i)));
    return count;
}

} // namespace photonloupe
