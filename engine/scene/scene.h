// SPDX-License-Identifier: Apache-2.0
// The scene as a value: what glTF gave us, in world space, ready for the kernels.
#pragma once

#include <array>
#include <bit>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/environment_map.h"
#include "shared/scene.h"

namespace photonloupe {

struct Bounds {
    std::array<double, 3> lo{};
    std::array<double, 3> hi{};
};

// One drawn primitive of one node; `Triangle::v0_object` indexes these.
struct SceneObject {
    std::string name;
    std::uint32_t material = 0;
    std::uint32_t triangle_count = 0;
};

// A perspective camera; `right`, `up`, `backward` are the orthonormal world axes of its node (glTF looks along -z).
struct Camera {
    std::string name;
    std::array<double, 3> position{}; // world, not relative to the origin
    std::array<double, 3> right{1, 0, 0};
    std::array<double, 3> up{0, 1, 0};
    std::array<double, 3> backward{0, 0, 1};
    double yfov = 0.8;   // radians
    double aspect = 0.0; // 0: none given
};

// What the loader understood, and what it left out.
struct SceneReport {
    std::vector<std::string> ignored; // features present in the file that nothing models, one sentence each
    std::vector<std::string> notes; // what was changed or dropped on the way (degenerate triangles, missing normals …)
    bool has_mirror = false;
    bool has_rough = false; // metal or glass
    bool has_dielectric = false;
    bool has_thin = false;
    bool has_absorption = false;
    bool has_alpha = false;
    bool has_translucency = false;
    bool has_layers = false; // gloss or coat
    bool has_dispersion = false;
    bool has_media = false;          // that scatter light
    bool has_colored_lamps = false;  // textured unevenly
    bool has_mixed_receiver = false; // a surface that is diffuse in part
    bool has_diffuse = false;
    bool has_emission = false;
};

struct Scene {
    std::filesystem::path path;
    std::string hash;                        // of the file, every buffer and image it uses and the additions, hex
    std::vector<std::string> additions;      // what was added to the file's (scene/edit_scene.h), JSON each
    std::array<double, 3> origin{};          // world position of the kernels' (0, 0, 0)
    Bounds bounds;                           // world
    std::vector<shared::Triangle> triangles; // in BVH leaf order
    std::vector<shared::TriangleNormals> normals;
    std::vector<shared::CornerCoordinates> corner_coordinates; // by triangle; empty without textures
    std::vector<shared::CornerColors> corner_colors;           // by triangle; empty where all are white
    std::vector<shared::BvhNode> nodes;                        // nodes[0] is the root; empty without triangles
    std::vector<shared::Material> materials;
    std::vector<std::string> material_names;
    std::vector<shared::MaterialPaint> paints; // of the materials; empty without textures
    std::vector<shared::Texture> textures;
    std::vector<std::uint32_t> atlas; // ATLAS_TABLE_SIZE linear values, then texels
    std::vector<SceneObject> objects;
    std::vector<shared::Light> lights;
    std::vector<std::string> light_names;
    std::vector<shared::EmittingTriangle> emitting;    // of area lights
    std::shared_ptr<const EnvironmentMap> environment; // none, or an image; shared by copies of the scene
    std::vector<Camera> cameras;
    SceneReport report;
};

// Index of a triangle's material.
inline std::uint32_t find_material(const shared::Triangle& triangle) {
    return std::bit_cast<std::uint32_t>(triangle.v1_material.w);
}

inline std::uint32_t find_kind(const shared::Light& light) {
    return std::bit_cast<std::uint32_t>(light.position_kind.w);
}

// 1 - cos of a cone's angle, which keeps the digits of narrow ones.
float find_cap(double angle);
// Its inverse, radians.
double find_cone_angle(float cap);

// point, spot, directional, area or environment.
const char* name_kind(const shared::Light& light);

// "2 point lights and 1 area light".
std::string count_lights(const Scene& scene);

inline bool has_image(const shared::Light& light) {
    return find_kind(light) == shared::LIGHT_ENVIRONMENT && light.cone.x > 0;
}

inline bool has_gloss(const shared::Material& material) {
    return material.gloss.x > 0 || material.gloss.y > 0 || material.gloss.z > 0 || material.gloss.w > 0;
}

// Light bends and is weakened inside: transmissive and not thin.
inline bool is_solid(const shared::Material& material) {
    return material.base_color_metallic.w < 1 && material.emission_transmission.w > 0 && material.roughness_thin.y == 0;
}

inline bool scatters(const shared::Material& material) {
    return is_solid(material) && (material.medium.x > 0 || material.medium.y > 0 || material.medium.z > 0);
}

inline bool is_two_sided(const shared::Material& material) {
    return material.roughness_thin.z > 0;
}

// Whether photons of one light differ in color.
inline bool has_colored_emission(const Scene& scene) {
    return scene.environment || scene.report.has_colored_lamps;
}

// Reads a .gltf or .glb file behind the project's wall. Throws SceneError with what, where and what to do.
// `time`, s: where the file's first animation has things then; else they are at rest.
Scene load_scene(const std::filesystem::path& path, std::optional<double> time = std::nullopt);

// What the scene requires of the kernels, and what they leave out for it.
struct SceneFeatures {
    std::vector<std::string> required;
    std::vector<std::string> left_out;
};

SceneFeatures list_features(const Scene& scene);

// Human-readable account of the scene: counts, bounds, lights, materials, what is modelled and what was left out.
std::string describe_scene(const Scene& scene);

} // namespace photonloupe
