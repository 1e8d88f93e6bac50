// SPDX-License-Identifier: Apache-2.0
// The photon map as a value: columns on the device, photon ids are their indices.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "gpu/buffer.h"

namespace photonloupe {

// The photons' paths: photon i owns vertices starts[i] … starts[i + 1] - 1, from the emitter to the storage point.
struct PathColumns {
    std::uint64_t vertex_count = 0;
    gpu::Buffer starts;   // uint, one more than photons
    gpu::Buffer vertices; // xyz metres from the map's origin, w bits: interaction << 24 | object
    gpu::Buffer normals;  // xyz unit, facing the arriving light; w scatter (0 mirror-like … 1 diffuse)
};

struct PhotonMap {
    std::uint64_t count = 0;
    std::array<double, 3> origin{};   // world position of the columns' (0, 0, 0)
    gpu::Buffer position_emitter;     // xyz metres from the origin, w bits: emitter
    gpu::Buffer normal_index;         // xyz unit, facing the arriving light; w bits: emitted index
    gpu::Buffer power_object;         // rgb flux in W, w bits: object
    std::optional<PathColumns> paths; // only when asked for
};

} // namespace photonloupe
