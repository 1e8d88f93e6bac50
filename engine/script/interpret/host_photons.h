// SPDX-License-Identifier: Apache-2.0
// A photon map as the interpreter reads it: plain arrays on the host, fetched when first asked for.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "script/plan/plan.h"
#include "script/program.h"

namespace photonloupe::script {

struct HostPhotons {
    std::uint32_t count = 0;
    // World coordinates, three floats a photon or vertex.
    std::vector<float> positions, normals, power;
    std::vector<std::int32_t> emitters;
    std::vector<std::int64_t> path_starts; // one more than photons
    std::vector<float> path_vertices, path_normals, path_scatter;
    std::vector<std::uint8_t> path_interactions;
    std::vector<std::int32_t> path_objects; // -1: none

    std::uint32_t fetched = 0; // Columns
    std::function<void(HostPhotons&, std::uint32_t columns)> fetch;
    // Ids of the nearest photons, nearest first, ties by id, without the photon itself; fewer where there are fewer.
    std::function<std::vector<std::int32_t>(NeighborQuery::Space, std::uint32_t photon, std::uint32_t k, float beta)>
        find_neighbors;

    void require(std::uint32_t columns) {
        const std::uint32_t missing = columns & ~fetched;
        if (missing && fetch)
            fetch(*this, missing);
        fetched |= missing;
    }
};

} // namespace photonloupe::script
