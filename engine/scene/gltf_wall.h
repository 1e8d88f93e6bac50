// SPDX-License-Identifier: Apache-2.0
// The wall in front of the glTF parser: only what was checked here is ever shown to it.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf_accessors.h"
#include "scene/gltf_animations.h"
#include "scene/gltf_textures.h"

namespace photonloupe {

// A scene file that was taken apart, checked and written anew from known members only.
struct ApprovedGltf {
    std::string json; // has no buffers, images, extras or unknown extensions
    BufferBytes buffers;
    std::vector<AccessorColumn> columns;    // by accessor, into the buffers
    std::vector<MaterialTextures> textures; // of the materials
    std::vector<ImageFile> images;
    std::vector<AnimationChannel> animation; // where it is asked for
    std::string hash; // XXH3-128 of the file's JSON, its buffers and the images that materials use, hex
    std::vector<std::string> ignored;
};

// `name` is what messages call the file. URIs are resolved below `folder`; an empty folder allows embedded data only.
// `is_animated`: animations are checked and read too.
ApprovedGltf approve_gltf(std::span<const unsigned char> bytes, const std::filesystem::path& folder,
                          const std::string& name, bool is_animated = false);

} // namespace photonloupe
