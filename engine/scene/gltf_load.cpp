// SPDX-License-Identifier: Apache-2.0
// load_scene: wall, parser, then triangles, materials, lights, cameras and BVH.
#include "scene/gltf_load.h"

#include <tiny_gltf.h>

#include "core/error.h"
#include "scene/bvh.h"
#include "scene/emitting_objects.h"
#include "scene/gltf_container.h"
#include "scene/gltf_wall.h"
#include "scene/limits.h"
#include "scene/load_lights.h"
#include "scene/load_materials.h"
#include "scene/load_textures.h"
#include "scene/load_triangles.h"
#include "scene/place_nodes.h"
#include "scene/pose_nodes.h"

namespace photonloupe {
namespace {

tinygltf::Model parse_approved(const ApprovedGltf& approved, const std::string& name) {
    tinygltf::TinyGLTF parser;
    tinygltf::Model model;
    std::string error, warning;
    const bool ok = parser.LoadASCIIFromString(&model, &error, &warning, approved.json.data(),
                                               static_cast<unsigned int>(approved.json.size()), "");
    if (!ok)
        throw SceneError(name + ": the glTF parser refused it: " + error + "; export it again");
    return model;
}

} // namespace

Scene load_scene_from_memory(std::span<const unsigned char> bytes, const std::filesystem::path& folder,
                             const std::string& name, std::optional<double> time) {
    const ApprovedGltf approved = approve_gltf(bytes, folder, name, time.has_value());
    Scene scene;
    scene.path = name;
    scene.hash = approved.hash;
    scene.report.ignored = approved.ignored;
    tinygltf::Model model = parse_approved(approved, name);
    if (time)
        pose_nodes(model, approved.animation, *time);
    const std::vector<PlacedNode> nodes = place_nodes(model);
    const TextureRanges ranges = load_textures(approved.textures, approved.images, scene);
    load_triangles(model, approved.columns, nodes, scene);
    load_materials(model, ranges, scene);
    load_lights(model, nodes, scene);
    load_cameras(model, nodes, scene);
    build_bvh(scene);
    list_emitting_objects(scene);
    return scene;
}

Scene load_scene(const std::filesystem::path& path, std::optional<double> time) {
    const std::string name = path.string();
    const std::vector<unsigned char> bytes = read_file_bytes(path, std::nullopt, MAX_FILE_BYTES, {nullptr, "", &name});
    const std::filesystem::path folder = path.parent_path();
    return load_scene_from_memory(bytes, folder.empty() ? "." : folder, name, time);
}

} // namespace photonloupe
