// SPDX-License-Identifier: Apache-2.0
// Photon tracing: from a scene to a photon map and the account of every emitted photon (METHODS §1).
#pragma once

#include "core/progress.h"
#include "photons/photon_map.h"
#include "scene/scene_buffers.h"
#include "trace/emitters.h"
#include "trace/settings.h"

namespace photonloupe {

// Where every emitted photon went: exact counts of paths, and flux in W per channel.
struct TraceReport {
    std::uint64_t emitted = 0;
    std::uint64_t absorbed = 0;
    std::uint64_t escaped = 0;
    std::uint64_t truncated = 0;
    std::uint64_t ended_on_receiver = 0;
    std::array<double, 3> flux_emitted{};
    std::array<double, 3> flux_deposited{}; // at all events, in minus out
    std::array<double, 3> flux_escaped{};
    std::array<double, 3> flux_truncated{};
    double solid_angle = 0; // sr, marked cells of all lights together
};

struct TracedPhotons {
    PhotonMap map;
    TraceReport report;
};

// Throws SceneError when nothing can be stored, MemoryError with what would fit, Cancelled on request.
TracedPhotons trace_photons(gpu::Device& device, const Scene& scene, const SceneBuffers& buffers,
                            const EmitterTable& emitters, const TraceSettings& settings, const Progress& progress = {});

} // namespace photonloupe
