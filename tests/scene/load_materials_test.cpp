// SPDX-License-Identifier: Apache-2.0
// What load_scene makes of materials, lights and cameras, and how a scene is described.
#include "scene/gltf_builder.h"

#include <cmath>

#include <glm/vec3.hpp>

#include <gtest/gtest.h>

#include "core/error.h"

namespace photonloupe::test {
namespace {

Scene load_with_material(const char* material) {
    GltfBuilder builder;
    builder.add_material(Json::parse(material));
    builder.add_object({{"attributes", {{"POSITION", builder.add_vectors(RIGHT_TRIANGLE)}}}, {"material", 0}});
    return load(builder);
}

Scene load_node(const Json& node, const char* lights, const char* cameras = "[]") {
    GltfBuilder builder = make_triangle();
    builder.document["nodes"].push_back(node);
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(lights);
    builder.document["cameras"] = Json::parse(cameras);
    return load(builder);
}

TEST(load_materials, gltfs_defaults_are_metallic_1_and_roughness_1) {
    const Scene scene = load_with_material("{}");
    EXPECT_EQ(scene.materials[0].base_color_metallic, glm::vec4(1, 1, 1, 1));
    EXPECT_EQ(scene.materials[0].roughness_thin, glm::vec4(1, 0, 0, 0));
    EXPECT_EQ(scene.materials[0].absorption_ior, glm::vec4(0, 0, 0, 1.5f));
    EXPECT_TRUE(scene.report.has_mirror);
    EXPECT_TRUE(scene.report.has_rough);
}

TEST(load_materials, a_primitive_without_material_gets_gltfs_default_and_a_note) {
    GltfBuilder builder = make_triangle();
    builder.add_material(Json::parse(R"({"name": "unused", "emissiveFactor": [1, 1, 1]})"));
    const Scene scene = load(builder);
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.material_names[1], "glTF default");
    EXPECT_EQ(scene.objects[0].material, 1u);
    EXPECT_EQ(scene.materials[1].base_color_metallic, glm::vec4(1, 1, 1, 1));
    EXPECT_TRUE(contains(scene.report.notes, "1 primitive has no material"));
    EXPECT_FALSE(scene.report.has_emission); // nothing that is drawn emits
}

TEST(load_materials, an_opaque_non_metal_is_lambert_and_its_specular_lobe_is_listed) {
    const Scene scene = load_with_material(
        R"({"name": "plaster", "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0.5, 0.25, 0.75, 1]}})");
    EXPECT_EQ(scene.materials[0].base_color_metallic, glm::vec4(0.5f, 0.25f, 0.75f, 0));
    EXPECT_TRUE(scene.report.has_diffuse);
    EXPECT_FALSE(scene.report.has_mirror || scene.report.has_dielectric || scene.report.has_thin);
    EXPECT_TRUE(contains(scene.report.ignored, "material \"plaster\": the specular lobe"));
    EXPECT_FALSE(contains(scene.report.ignored, "roughness")); // Lambert has none
}

const char* const GLASS = R"({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}, "extensions": {
    "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.33},
    "KHR_materials_volume": {"thicknessFactor": 0.1, "attenuationDistance": 2, "attenuationColor": [1, 0.5, 0]}}})";

TEST(load_materials, glass_with_thickness_is_solid_and_absorbs_by_beer_lambert) {
    const Scene scene = load_with_material(GLASS);
    const glm::vec4 absorption_ior = scene.materials[0].absorption_ior;
    EXPECT_EQ(absorption_ior.x, 0.0f);
    EXPECT_NEAR(std::exp(-absorption_ior.y * 2.0f), 0.5f, 1e-6f);
    EXPECT_NEAR(absorption_ior.z, 43.67f, 0.01f); // black is read as the smallest normal float
    EXPECT_EQ(absorption_ior.w, 1.33f);
    EXPECT_EQ(scene.materials[0].roughness_thin.y, 0.0f);
    EXPECT_TRUE(scene.report.has_dielectric && scene.report.has_absorption);
    EXPECT_FALSE(scene.report.has_thin || scene.report.has_diffuse || scene.report.has_mirror);
    EXPECT_TRUE(scene.report.ignored.empty());
}

TEST(load_materials, glass_without_volume_or_thickness_is_thin) {
    Json material = Json::parse(GLASS);
    material["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 0;
    for (int i = 0; i < 2; ++i) {
        const Scene scene = load_with_material(material.dump().c_str());
        EXPECT_EQ(scene.materials[0].roughness_thin.y, 1.0f);
        EXPECT_EQ(scene.materials[0].absorption_ior.y, 0.0f);
        EXPECT_TRUE(scene.report.has_thin);
        EXPECT_FALSE(scene.report.has_dielectric || scene.report.has_absorption);
        material["extensions"].erase("KHR_materials_volume");
    }
}

TEST(load_materials, an_attenuation_distance_below_floats_is_refused) {
    Json material = Json::parse(GLASS);
    material["extensions"]["KHR_materials_volume"]["attenuationDistance"] = 1e-300;
    EXPECT_THROW(load_with_material(material.dump().c_str()), SceneError);
}

TEST(load_materials, emission_is_scaled_by_its_strength_and_shines) {
    const Scene scene = load_with_material(R"({"name": "lamp", "emissiveFactor": [1, 0.5, 0],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}}})");
    EXPECT_EQ(glm::vec3(scene.materials[0].emission_transmission), glm::vec3(8, 4, 0));
    EXPECT_TRUE(scene.report.has_emission);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_STREQ(name_kind(scene.lights[0]), "area");
    EXPECT_EQ(glm::vec3(scene.lights[0].intensity), glm::vec3(8, 4, 0));
    EXPECT_EQ(scene.lights[0].cone.x, 0.5f); // m²
}

TEST(load_lights, a_point_light_is_placed_by_its_node_in_watts_per_steradian) {
    const Scene scene = load_node(
        {{"name", "lamp"}, {"translation", {1, 2, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}},
        R"([{"type": "spot", "spot": {}},
                                      {"type": "point", "color": [1, 0.5, 0], "intensity": 10}])");
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(glm::vec3(scene.lights[0].position_kind), glm::vec3(1, 2, 3));
    EXPECT_EQ(glm::vec3(scene.lights[0].intensity), glm::vec3(10, 5, 0));
    EXPECT_EQ(scene.light_names[0], "lamp");
}

TEST(load_lights, defaults_are_white_and_1) {
    const Scene scene =
        load_node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}, R"([{"type": "point"}])");
    EXPECT_EQ(glm::vec3(scene.lights.at(0).intensity), glm::vec3(1));
}

TEST(load_lights, positions_are_relative_to_the_origin) {
    GltfBuilder builder;
    builder.add_triangles(RIGHT_TRIANGLE, {{"translation", {1e6, 0, 0}}});
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([{"type": "point"}])");
    builder.document["nodes"].push_back(
        {{"translation", {1e6 + 0.25, 0, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.origin[0], 1e6 + 0.5);
    EXPECT_EQ(glm::vec3(scene.lights.at(0).position_kind), glm::vec3(-0.25f, -0.5f, 2));
}

TEST(load_cameras, axes_are_orthonormal_and_right_handed_under_scale_shear_and_mirroring) {
    const Scene scene =
        load_node({{"name", "eye"}, {"camera", 0}, {"matrix", {-2, 0, 0, 0, 0.5, 3, 0, 0, 0, 0.1, 0.5, 0, 1, 2, 3, 1}}},
                  "[]", R"([{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}])");
    ASSERT_EQ(scene.cameras.size(), 1u);
    const Camera& camera = scene.cameras[0];
    const auto dot = [](const auto& a, const auto& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    EXPECT_NEAR(dot(camera.right, camera.up), 0, 1e-15);
    EXPECT_NEAR(dot(camera.right, camera.backward), 0, 1e-15);
    EXPECT_NEAR(dot(camera.up, camera.up), 1, 1e-15);
    EXPECT_NEAR(camera.right[1] * camera.up[2] - camera.right[2] * camera.up[1], camera.backward[0], 1e-15);
    EXPECT_NEAR(camera.backward[2], 0.5 / std::sqrt(0.26), 1e-15);
    EXPECT_EQ(camera.position, (std::array<double, 3>{1, 2, 3}));
    EXPECT_EQ(camera.name, "eye");
    EXPECT_EQ(camera.yfov, 0.7);
    EXPECT_EQ(camera.aspect, 0.0);
}

TEST(load_cameras, a_camera_without_a_view_axis_is_refused_by_name) {
    EXPECT_THROW(load_node({{"camera", 0}, {"scale", {1, 1, 0}}}, "[]",
                           R"([{"type": "perspective", "perspective": {"yfov": 0.7}}])"),
                 SceneError);
}

TEST(describe_scene, it_says_what_is_there_and_what_is_not) {
    GltfBuilder builder;
    builder.add_material(Json::parse(GLASS));
    builder.document["materials"][0]["name"] = "water";
    builder.add_object({{"attributes", {{"POSITION", builder.add_vectors(RIGHT_TRIANGLE)}}}, {"material", 0}});
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::parse(R"([{"type": "point", "intensity": 10}])");
    builder.document["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const std::string text = describe_scene(load(builder));
    for (const char* part :
         {"test.gltf", "1 triangles in 1 objects", "water: glass", "ior 1.33", "125.664", "1 light\n",
          "required: dielectrics, absorption", "left out: Lambert, mirrors", "no normals"})
        EXPECT_CONTAINS(text, part);
}

TEST(shipped_scenes, every_scene_in_the_repository_loads_with_a_light_and_a_camera) {
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(PHOTONLOUPE_SOURCE_DIR "/scenes")) {
        if (entry.path().extension() != ".gltf")
            continue;
        const Scene scene = load_scene(entry.path());
        EXPECT_FALSE(scene.triangles.empty() || scene.lights.empty() || scene.cameras.empty()) << entry.path();
        ++count;
    }
    EXPECT_GT(count, 0);
}

} // namespace
} // namespace photonloupe::test
