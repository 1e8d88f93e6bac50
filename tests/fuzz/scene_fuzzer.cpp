// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes load as a scene or are refused with SceneError.
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/error.h"
#include "scene/gltf_load.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        // No folder: only embedded data is accepted, so the file system is not touched.
        const photonloupe::Scene scene =
            photonloupe::load_scene_from_memory(std::span<const unsigned char>(data, size), {}, "fuzz");
        photonloupe::describe_scene(scene);
    } catch (const photonloupe::SceneError&) {
    }
    return 0;
}
