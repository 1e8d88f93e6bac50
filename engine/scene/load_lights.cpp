// SPDX-License-Identifier: Apache-2.0
// Lights as radiant intensity per channel; cameras with orthonormal axes.
#include "scene/load_lights.h"

#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/json_place.h"
#include "scene/limits.h"
#include "scene/triangle_math.h"

namespace photonloupe {
namespace {

std::array<double, 3> to_array(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

void load_light(const tinygltf::Light& light, const PlacedNode& node, const std::string& name, Scene& scene) {
    glm::vec3 position, intensity;
    for (int i = 0; i < 3; ++i) {
        const double relative = node.world[3][i] - scene.origin[std::size_t(i)];
        if (!(std::abs(relative) <= MAX_COORDINATE))
            throw SceneError(scene.path.string() + ": light " + quote_text(name) +
                             " is more than 1e30 away, which 32-bit floats can't compute with; move it closer");
        position[i] = float(relative);
        const double channel = light.color.empty() ? 1.0 : light.color[std::size_t(i)];
        intensity[i] = float(channel * light.intensity);
    }
    shared::Light placed{{position, std::bit_cast<float>(shared::LIGHT_POINT)}, {intensity, 0.0f}, {}, {}};
    if (light.type != "point") {
        const auto backward = normalize_robustly(glm::dvec3(node.world[2])); // lights shine along -z
        if (!backward)
            throw SceneError(scene.path.string() + ": the node of light " + quote_text(name) +
                             " has a singular or infinite transform; give it a scale of 1");
        placed.direction = {glm::vec3(-*backward), 0.0f};
        placed.position_kind.w =
            std::bit_cast<float>(light.type == "spot" ? shared::LIGHT_SPOT : shared::LIGHT_DIRECTIONAL);
    }
    if (light.type == "spot")
        placed.cone = {find_cap(light.spot.innerConeAngle), find_cap(light.spot.outerConeAngle), 0.0f, 0.0f};
    scene.lights.push_back(placed);
    scene.light_names.push_back(name);
}

// glTF cameras look along -z of their node; scale is taken out, and a mirrored node gives a camera that is not.
Camera place_camera(const tinygltf::Camera& camera, const PlacedNode& node, const std::string& name,
                    const Scene& scene) {
    const auto backward = normalize_robustly(glm::dvec3(node.world[2]));
    const auto up_hint = normalize_robustly(glm::dvec3(node.world[1]));
    const auto up =
        backward && up_hint ? normalize_robustly(*up_hint - *backward * glm::dot(*backward, *up_hint)) : std::nullopt;
    if (!up || !std::isfinite(glm::dot(glm::dvec3(node.world[3]), glm::dvec3(1.0))))
        throw SceneError(scene.path.string() + ": the node of camera " + quote_text(name) +
                         " has a singular or infinite transform; give it a scale of 1");
    Camera placed;
    placed.name = name;
    placed.position = to_array(glm::dvec3(node.world[3]));
    placed.right = to_array(glm::cross(*up, *backward));
    placed.up = to_array(*up);
    placed.backward = to_array(*backward);
    placed.yfov = camera.perspective.yfov;
    placed.aspect = camera.perspective.aspectRatio;
    return placed;
}

} // namespace

void load_lights(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes, Scene& scene) {
    for (const PlacedNode& node : nodes) {
        const auto& extensions = model.nodes[node.node].extensions;
        const auto extension = extensions.find("KHR_lights_punctual");
        if (extension == extensions.end())
            continue;
        const auto index = std::size_t(extension->second.Get("light").GetNumberAsInt());
        const tinygltf::Light& light = model.lights.at(index);
        load_light(light, node, name_node(model, node.node, light.name, "light"), scene);
    }
}

void load_cameras(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes, Scene& scene) {
    for (const PlacedNode& node : nodes) {
        const int index = model.nodes[node.node].camera;
        if (index < 0 || model.cameras[std::size_t(index)].type != "perspective")
            continue;
        const tinygltf::Camera& camera = model.cameras[std::size_t(index)];
        scene.cameras.push_back(place_camera(camera, node, name_node(model, node.node, camera.name, "camera"), scene));
    }
}

} // namespace photonloupe
