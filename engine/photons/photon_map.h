// SPDX-License-Identifier: Apache-2.0
// The photon map as a value: columns on the device, photon ids are their indices.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/buffer.h"

namespace photonloupe {

// The photons' paths: photon i owns vertices starts[i] … starts[i + 1] - 1, from the emitter to the storage point.
struct PathColumns {
    std::uint64_t vertex_count = 0;
    gpu::Buffer starts;   // uint, one more than photons
    gpu::Buffer vertices; // xyz metres from the map's origin, w bits: interaction << 24 | object
    gpu::Buffer normals;  // xyz unit, facing the arriving light; w scatter (0 mirror-like … 1 diffuse)
    // Whether they were recorded or given, and are not just filled with nothing.
    bool has_normals = true, has_interactions = true, has_objects = true, has_scatter = true;
};

// A column of the host that maps share: nobody changes it.
using SharedFloats = std::shared_ptr<const std::vector<float>>;

// One dimension of parameter space, as it was declared: what views show of it.
struct ParameterAxis {
    std::string name;
    double low = 0, high = 0; // bounds; they never scale distances
    double period = 0;        // 0: it does not wrap
};

// The photons' parameters (METHODS §4), as a script or a user set them.
struct ParameterColumns {
    std::uint32_t count = 0;         // 1–13
    gpu::Buffer values;              // count_rows() vec4s a photon, by id; NaN: the photon has none
    SharedFloats given;              // `count` a photon, as they were set
    std::vector<float> periods;      // per parameter; 0: it does not wrap
    std::vector<ParameterAxis> axes; // per parameter
    std::uint32_t count_rows() const { return (count + 3) / 4; }
    bool is_periodic() const {
        return std::any_of(periods.begin(), periods.end(), [](float period) { return period > 0; });
    }
};

struct PhotonMap {
    std::uint64_t count = 0;
    std::array<double, 3> origin{};   // world position of the columns' (0, 0, 0)
    gpu::Buffer position_emitter;     // xyz metres from the origin, w bits: emitter
    gpu::Buffer normal_index;         // xyz unit, facing the arriving light; w bits: emitted index
    gpu::Buffer power_object;         // rgb flux in W, w bits: object
    std::optional<PathColumns> paths; // only when asked for
    std::optional<ParameterColumns> parameters;
    std::optional<gpu::Buffer> colors;       // rgb as a script encoded them, grey where it did not; w 1: set
    SharedFloats given_colors;               // rgb a photon as the script gave them, NaN: none; null: no colors
    std::vector<std::uint64_t> long_indices; // emitted indices, where one is too large for `normal_index`
};

} // namespace photonloupe
