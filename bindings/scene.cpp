// SPDX-License-Identifier: Apache-2.0
// Binds engine/scene: loading, and the scene's parts as plain dictionaries.
#include "binding.h"

#include "scene/edit_scene.h"

namespace photonloupe::bindings {
namespace {

nb::list list_cameras(const Scene& scene) {
    nb::list rows;
    for (const Camera& camera : scene.cameras) {
        nb::dict row;
        row["name"] = camera.name;
        row["position"] = camera.position;
        row["right"] = camera.right;
        row["up"] = camera.up;
        row["backward"] = camera.backward;
        row["yfov"] = camera.yfov;
        row["aspect"] = camera.aspect;
        rows.append(row);
    }
    return rows;
}

nb::list list_lights(const Scene& scene) {
    nb::list rows;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const shared::Light& light = scene.lights[i];
        std::array<double, 3> position{}, intensity{};
        for (int axis = 0; axis < 3; ++axis) {
            position[axis] = light.position_kind[axis] + scene.origin[axis];
            intensity[axis] = light.intensity[axis];
        }
        nb::dict row;
        row["name"] = scene.light_names[i];
        row["kind"] = name_kind(light);
        row["position"] = position;
        row["intensity"] = intensity;
        if (find_kind(light) == shared::LIGHT_SPOT || find_kind(light) == shared::LIGHT_DIRECTIONAL)
            row["direction"] = std::array{light.direction.x, light.direction.y, light.direction.z};
        if (find_kind(light) == shared::LIGHT_SPOT)
            row["cone"] = std::array{find_cone_angle(light.cone.x), find_cone_angle(light.cone.y)};
        if (find_kind(light) == shared::LIGHT_AREA) {
            row["area"] = light.cone.x;
            row["two_sided"] = light.cone.w > 1;
        }
        if (has_image(light))
            row["image"] = scene.environment->path.string();
        rows.append(row);
    }
    return rows;
}

std::array<double, 3> take_rgb(const glm::vec4& v) {
    return {v.r, v.g, v.b};
}

const char* name_alpha_mode(const shared::Material& material) {
    return material.alpha.y == shared::ALPHA_MASK    ? "mask"
           : material.alpha.y == shared::ALPHA_BLEND ? "blend"
                                                     : "opaque";
}

nb::list list_materials(const Scene& scene) {
    nb::list rows;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const shared::Material& material = scene.materials[i];
        nb::dict row;
        row["name"] = scene.material_names[i];
        row["base_color"] = take_rgb(material.base_color_metallic);
        row["metallic"] = material.base_color_metallic.w;
        row["transmission"] = material.emission_transmission.w;
        row["ior"] = material.absorption_ior.w;
        row["absorption"] = take_rgb(material.absorption_ior);
        row["emission"] = take_rgb(material.emission_transmission);
        row["roughness"] = material.roughness_thin.x;
        row["thin"] = material.roughness_thin.y > 0;
        row["alpha"] = material.alpha.x;
        row["alpha_mode"] = name_alpha_mode(material);
        row["dispersion"] = material.alpha.w;
        row["diffuse_transmission"] = material.translucency.w;
        row["diffuse_transmission_color"] = take_rgb(material.translucency);
        row["gloss"] = take_rgb(material.gloss);
        row["coat"] = material.coat.x;
        row["coat_roughness"] = material.coat.y;
        rows.append(row);
    }
    return rows;
}

nb::list list_objects(const Scene& scene) {
    nb::list rows;
    for (const SceneObject& object : scene.objects) {
        nb::dict row;
        row["name"] = object.name;
        row["material"] = object.material;
        row["triangle_count"] = object.triangle_count;
        rows.append(row);
    }
    return rows;
}

nb::dict describe_report(const Scene& scene) {
    const SceneFeatures features = list_features(scene);
    nb::dict row;
    row["ignored"] = scene.report.ignored;
    row["notes"] = scene.report.notes;
    row["requires"] = features.required;
    row["left_out"] = features.left_out;
    return row;
}

} // namespace

void bind_scene(nb::module_& module) {
    nb::class_<Scene>(module, "Scene")
        .def_prop_ro("path", [](const Scene& scene) { return scene.path.string(); })
        .def_ro("hash", &Scene::hash)
        .def_ro("origin", &Scene::origin)
        .def_prop_ro("additions", [](const Scene& scene) { return scene.additions; })
        .def_prop_ro("bounds", [](const Scene& scene) { return nb::make_tuple(scene.bounds.lo, scene.bounds.hi); })
        .def_prop_ro("cameras", &list_cameras)
        .def_prop_ro("lights", &list_lights)
        .def_prop_ro("materials", &list_materials)
        .def_prop_ro("objects", &list_objects)
        .def_prop_ro("report", &describe_report)
        .def_prop_ro("triangle_count", [](const Scene& scene) { return scene.triangles.size(); })
        .def("describe", &describe_scene);
    module.def(
        "add_to_scene", [](const Scene& scene, const std::string& text) { return add_to_scene(scene, text); },
        nb::arg("scene"), nb::arg("addition"), nb::call_guard<nb::gil_scoped_release>(),
        "A copy with a light or a floor more; addition as engine/scene/edit_scene.h has it.");
    module.def(
        "load_scene", [](const std::string& path) { return load_scene(path); }, nb::arg("path"),
        nb::call_guard<nb::gil_scoped_release>(), "Read a glTF scene (.gltf or .glb).");
}

} // namespace photonloupe::bindings
