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
#include "scene/load_triangles.h"
#include "scene/place_nodes.h"

namespace photonloupe {
namespace {

std::optional<std::size_t> find_buffer(const BufferBytes& buffers, const std::string& name) {
    for (std::size_t i = 0; i < buffers.size(); ++i)
        if (name == name_buffer(i))
            return i;
    return std::nullopt;
}

// File callbacks that know nothing but the approved buffers (`user_data` is a BufferBytes).
tinygltf::FsCallbacks make_buffer_callbacks(BufferBytes& buffers) {
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = [](const std::string& name, void* user_data) {
        return find_buffer(*static_cast<BufferBytes*>(user_data), name).has_value();
    };
    callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*, const std::string& name,
                                 void* user_data) {
        auto& approved = *static_cast<BufferBytes*>(user_data);
        const std::optional<std::size_t> index = find_buffer(approved, name);
        if (index)
            *out = std::move(approved[*index]); // each buffer is asked for once
        return index.has_value();
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    callbacks.user_data = &buffers;
    return callbacks;
}

bool refuse_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
    return false;
}

tinygltf::Model parse_approved(ApprovedGltf& approved, const std::string& name) {
    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks(make_buffer_callbacks(approved.buffers));
    parser.SetImageLoader(&refuse_image, nullptr);
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
                             const std::string& name) {
    ApprovedGltf approved = approve_gltf(bytes, folder, name);
    Scene scene;
    scene.path = name;
    scene.hash = approved.hash;
    scene.report.ignored = approved.ignored;
    const tinygltf::Model model = parse_approved(approved, name);
    const std::vector<PlacedNode> nodes = place_nodes(model);
    load_triangles(model, nodes, scene);
    load_materials(model, scene);
    load_lights(model, nodes, scene);
    load_cameras(model, nodes, scene);
    scene.nodes = build_bvh(scene.triangles, scene.normals);
    list_emitting_objects(scene);
    return scene;
}

Scene load_scene(const std::filesystem::path& path) {
    const std::string name = path.string();
    const std::vector<unsigned char> bytes = read_file_bytes(path, std::nullopt, MAX_FILE_BYTES, {nullptr, "", &name});
    const std::filesystem::path folder = path.parent_path();
    return load_scene_from_memory(bytes, folder.empty() ? "." : folder, name);
}

} // namespace photonloupe
