// SPDX-License-Identifier: Apache-2.0
// Appends lights and triangles to a copy of a scene and builds anew what depends on them.
#include "scene/edit_scene.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/hash.h"
#include "core/json_place.h"
#include "image/exr.h"
#include "scene/bvh.h"
#include "scene/emitting_objects.h"
#include "scene/limits.h"
#include "scene/load_materials.h"
#include "scene/triangle_math.h"

namespace photonloupe {
namespace {

using glm::dvec3;

constexpr NumberRange TIME{-1e9, 1e9}; // s
constexpr NumberRange POWER{0.0, 1e30}, PLACE{-MAX_COORDINATE, MAX_COORDINATE}, ANGLE{0.0, 1.5707963267948966};
// Of the key light: where it stands, in radii of the bounds' ball from its middle, and the irradiance there.
const dvec3 KEY_PLACE(0.8, 1.8, 1.2);
constexpr double KEY_IRRADIANCE = 3.0; // W/m²
// Of the floor: half its side in radii, and how far below the scene it lies.
constexpr double FLOOR_REACH = 4.0, FLOOR_GAP = 1e-3;
constexpr float FLOOR_ALBEDO = 0.5f;
constexpr std::size_t MOST_ADDITIONS = 256;
constexpr std::string_view MEMBERS[] = {"add",  "kind", "position", "direction", "intensity", "color", "size",
                                        "cone", "y",    "image",    "hash",      "rotation",  "time"};
constexpr double TURN = 6.283185307179586; // radians

dvec3 read_vector(const JsonPlace& place, std::vector<double> fallback, NumberRange range) {
    const std::vector<double> values = read_numbers_or(place, std::move(fallback), range);
    return {values.at(0), values.at(1), values.at(2)};
}

dvec3 read_direction(const JsonPlace& addition) {
    const JsonPlace place = find_member(addition, "direction");
    const auto direction = normalize_robustly(read_vector(place, {0, -1, 0}, PLACE));
    if (!direction)
        refuse(place, "it has no direction", "give a vector that is not zero");
    return *direction;
}

// Middle and radius of the ball around the bounds.
std::pair<dvec3, double> find_ball(const Scene& scene) {
    dvec3 lo, hi;
    for (int axis = 0; axis < 3; ++axis) {
        lo[axis] = scene.bounds.lo[std::size_t(axis)];
        hi[axis] = scene.bounds.hi[std::size_t(axis)];
    }
    const double radius = 0.5 * glm::length(hi - lo);
    return {0.5 * (lo + hi), radius > 0 ? radius : 1.0};
}

glm::vec3 localize(const Scene& scene, const dvec3& place) {
    return {place.x - scene.origin[0], place.y - scene.origin[1], place.z - scene.origin[2]};
}

// Two triangles around a middle; their normal is the cross product of the half sides.
void add_square(Scene& scene, const std::string& name, const shared::Material& material, const dvec3& middle,
                const dvec3& half_u, const dvec3& half_v) {
    const auto object = static_cast<std::uint32_t>(scene.objects.size());
    const auto index = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
    scene.material_names.push_back(name);
    if (!scene.paints.empty())
        scene.paints.emplace_back();
    scene.objects.push_back({name, index, 2});
    // Of what is wide, such as a floor, only the height counts: cameras fit the rest.
    const double reach = glm::length(half_u) + glm::length(half_v);
    const bool is_wide = reach > find_ball(scene).second;
    for (std::size_t axis = is_wide ? 1 : 0; axis < (is_wide ? 2 : 3); ++axis) {
        const double extent = std::abs(half_u[int(axis)]) + std::abs(half_v[int(axis)]);
        scene.bounds.lo[axis] = std::min(scene.bounds.lo[axis], middle[int(axis)] - extent);
        scene.bounds.hi[axis] = std::max(scene.bounds.hi[axis], middle[int(axis)] + extent);
    }
    const glm::vec4 normal(glm::vec3(glm::normalize(glm::cross(half_u, half_v))), 0.0f);
    const std::array<dvec3, 4> corners{middle - half_u - half_v, middle + half_u - half_v, middle + half_u + half_v,
                                       middle - half_u + half_v};
    for (std::uint32_t i = 0; i < 2; ++i) {
        scene.triangles.push_back({{localize(scene, corners[0]), std::bit_cast<float>(object)},
                                   {localize(scene, corners[i + 1]), std::bit_cast<float>(index)},
                                   {localize(scene, corners[i + 2]), std::bit_cast<float>(i)}});
        scene.normals.push_back({normal, normal, normal});
        if (!scene.corner_coordinates.empty())
            scene.corner_coordinates.emplace_back();
        if (!scene.corner_colors.empty())
            scene.corner_colors.push_back({glm::vec4(1.0f), glm::vec4(1.0f), glm::vec4(1.0f)});
    }
    report_material(material, material, "material " + quote_text(name), scene.report);
}

// Lights of objects that emit come last, and are listed again.
void rebuild(Scene& scene) {
    const std::size_t kept =
        std::find_if(scene.lights.begin(), scene.lights.end(),
                     [](const shared::Light& light) { return find_kind(light) == shared::LIGHT_AREA; }) -
        scene.lights.begin();
    scene.lights.resize(kept);
    scene.light_names.resize(kept);
    scene.emitting.clear();
    build_bvh(scene);
    list_emitting_objects(scene);
}

void add_area_light(Scene& scene, const JsonPlace& addition, const glm::vec3& radiance, const std::string& name) {
    const dvec3 direction = read_direction(addition);
    const std::vector<double> size = read_numbers_or(find_member(addition, "size"), {1, 1}, {1e-30, MAX_COORDINATE});
    const dvec3 other = std::abs(direction.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    const dvec3 u = glm::normalize(glm::cross(other, direction));
    shared::Material lamp{};
    lamp.absorption_ior.w = 1.5f;
    lamp.emission_transmission = glm::vec4(radiance, 0.0f);
    add_square(scene, name, lamp, read_vector(find_member(addition, "position"), {0, 0, 0}, PLACE),
               u * (0.5 * size.at(0)), glm::cross(direction, u) * (0.5 * size.at(1)));
    const shared::Triangle& corner = scene.triangles.back();
    const dvec3 area = compute_area_vector(corner.v0_object, corner.v1_material, corner.v2_source);
    const auto sides = static_cast<float>(glm::length(area));
    if (!(sides > 0) || !std::isfinite(sides))
        refuse(find_member(addition, "size"), "its area is none that 32-bit floats hold", "choose another size");
    rebuild(scene);
}

void insert_light(Scene& scene, const shared::Light& light, const std::string& name) {
    const auto place = std::find_if(scene.lights.begin(), scene.lights.end(),
                                    [](const shared::Light& other) { return find_kind(other) == shared::LIGHT_AREA; });
    scene.light_names.insert(scene.light_names.begin() + (place - scene.lights.begin()), name);
    scene.lights.insert(place, light);
}

void add_key_light(Scene& scene) {
    const auto [middle, radius] = find_ball(scene);
    const dvec3 place = middle + KEY_PLACE * radius;
    const double intensity = KEY_IRRADIANCE * radius * radius * glm::dot(KEY_PLACE, KEY_PLACE);
    insert_light(scene,
                 {{localize(scene, place), std::bit_cast<float>(shared::LIGHT_POINT)},
                  glm::vec4(glm::vec3(static_cast<float>(intensity)), 0.0f),
                  {},
                  {}},
                 "key light");
}

// The addition is written down with the hash of the file, so that it is known again.
void add_environment(Scene& scene, const JsonPlace& addition, shared::Light& light) {
    light.position_kind = {0, 0, 0, std::bit_cast<float>(shared::LIGHT_ENVIRONMENT)};
    const JsonPlace image = find_member(addition, "image");
    if (!image.value)
        return;
    if (scene.environment)
        refuse(addition, "the scene has an environment that an image says", "join the images in one");
    const std::string name = read_string(image);
    if (name.empty() || name.find('\0') != std::string::npos)
        refuse(image, "it names no file", "give the path of an equirectangular EXR file");
    const std::filesystem::path path = name;
    const double rotation = read_number_or(find_member(addition, "rotation"), 0.0, {-TURN, TURN});
    const std::vector<unsigned char> bytes = read_image_file(path.string());
    const std::string hash = hash_bytes({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    if (read_string_or(find_member(addition, "hash"), hash) != hash)
        throw SceneError(path.string() + ": the image has changed since it was added to " + scene.path.string() +
                         "; add it anew, or bring the old one back");
    const auto map = std::make_shared<const EnvironmentMap>(
        make_environment_map(path, decode_exr(path, bytes), glm::dvec3(light.intensity), rotation));
    if (map->negative_count > 0)
        scene.report.notes.push_back(path.string() + ": " + std::to_string(map->negative_count) +
                                     " negative values count as 0");
    light.intensity = glm::vec4(glm::vec3(map->mean), static_cast<float>(map->mean_largest));
    light.cone.x = 1.0f;
    scene.environment = map;
    Json known = *addition.value;
    known["hash"] = hash;
    scene.additions.back() = known.dump();
}

void add_light(Scene& scene, const JsonPlace& addition) {
    const std::string kind = read_string(require_member(addition, "kind"));
    if (kind == "auto")
        return add_key_light(scene);
    const std::string name = "added " + kind + " light " + std::to_string(scene.additions.size());
    const double intensity = read_number_or(find_member(addition, "intensity"), 1.0, POWER);
    const glm::vec3 color(read_vector(find_member(addition, "color"), {1, 1, 1}, POWER) * intensity);
    if (!(std::max({color.r, color.g, color.b}) <= static_cast<float>(POWER.hi)))
        refuse(addition, "color times intensity is beyond the range of 32-bit floats", "lower the intensity");
    if (kind == "area")
        return add_area_light(scene, addition, color, name);
    shared::Light light{{}, glm::vec4(color, 0.0f), {}, {}};
    const glm::vec3 place = localize(scene, read_vector(find_member(addition, "position"), {0, 0, 0}, PLACE));
    light.position_kind = {place, std::bit_cast<float>(shared::LIGHT_POINT)};
    if (kind == "spot" || kind == "directional")
        light.direction = glm::vec4(glm::vec3(read_direction(addition)), 0.0f);
    if (kind == "directional") {
        light.position_kind = {0, 0, 0, std::bit_cast<float>(shared::LIGHT_DIRECTIONAL)};
    } else if (kind == "spot") {
        const JsonPlace cone = find_member(addition, "cone");
        const std::vector<double> angles = read_numbers_or(cone, {0.0, 0.25 * 3.14159265358979}, ANGLE);
        if (!(angles.at(0) <= angles.at(1)) || !(angles.at(1) > 0))
            refuse(cone, "it must be an inner angle and an outer one that is no smaller", "swap them");
        light.position_kind.w = std::bit_cast<float>(shared::LIGHT_SPOT);
        light.cone = {find_cap(angles[0]), find_cap(angles[1]), 0.0f, 0.0f};
    } else if (kind == "environment") {
        add_environment(scene, addition, light);
    } else if (kind != "point") {
        refuse(find_member(addition, "kind"), quote_text(kind) + " is no kind of light that is modeled",
               "use point, spot, directional, area, environment or auto");
    }
    insert_light(scene, light, name);
}

void add_floor(Scene& scene, const JsonPlace& addition) {
    const auto [middle, radius] = find_ball(scene);
    const JsonPlace y = find_member(addition, "y");
    const bool has_height = y.value && !y.value->is_null();
    const double height = has_height ? read_number(y, PLACE) : scene.bounds.lo[1] - FLOOR_GAP * radius;
    shared::Material plaster{};
    plaster.base_color_metallic = glm::vec4(glm::vec3(FLOOR_ALBEDO), 0.0f);
    plaster.absorption_ior.w = 1.5f;
    plaster.roughness_thin = {1.0f, 0.0f, 1.0f, 0.0f};
    add_square(scene, "added floor", plaster, {middle.x, height, middle.z}, {0, 0, FLOOR_REACH * radius},
               {FLOOR_REACH * radius, 0, 0});
    rebuild(scene);
}

// The file again, with its things where they are then.
Scene pose_scene(const Scene& scene, const JsonPlace& addition) {
    if (!scene.additions.empty())
        refuse(addition, "the time comes after what was added", "give the time first");
    return load_scene(scene.path, read_number(require_member(addition, "time"), TIME));
}

} // namespace

Scene add_to_scene(const Scene& scene, const std::string& text) {
    const std::string name = scene.path.string();
    const Json parsed = Json::parse(text, nullptr, false);
    const JsonPlace addition{&parsed, "", &name};
    if (scene.additions.size() >= MOST_ADDITIONS)
        refuse(addition, "there are too many additions", "put them into the file");
    const Json none = Json::object();
    for (const auto& [member, value] : (parsed.is_object() ? parsed : none).items())
        if (std::find(std::begin(MEMBERS), std::end(MEMBERS), member) == std::end(MEMBERS))
            refuse(addition, quote_text(member) + " is nothing that an addition has", "leave it out");
    const std::string what = read_string(require_member(addition, "add"));
    Scene larger = what == "time" ? pose_scene(scene, addition) : scene;
    larger.additions.push_back(text);
    if (what == "light")
        add_light(larger, addition);
    else if (what == "floor")
        add_floor(larger, addition);
    else if (what != "time")
        refuse(find_member(addition, "add"), quote_text(what) + " cannot be added", "add a light or a floor");
    larger.hash = hash_bytes(larger.hash + larger.additions.back());
    return larger;
}

} // namespace photonloupe
