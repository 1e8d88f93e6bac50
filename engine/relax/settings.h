// SPDX-License-Identifier: Apache-2.0
// What relaxation can be told (METHODS §3–5); the same names in Python.
#pragma once

#include <array>
#include <cstdint>

#include "shared/relax.h"

namespace photonloupe {

enum class Descriptor : std::uint32_t {
    none = shared::DESCRIPTOR_NONE,
    gradient = shared::DESCRIPTOR_GRADIENT,
    pca = shared::DESCRIPTOR_PCA,
    tensor = shared::DESCRIPTOR_TENSOR,
    split = shared::DESCRIPTOR_SPLIT,
};

// Which photons count as neighbours.
enum class Space : std::uint32_t {
    world,     // all
    parameter, // those of the same layer: |q_j - q_i| ≤ β·r_q(i), same emitter
};

struct ConstraintSettings {
    Descriptor descriptor = Descriptor::pca;
    Space space = Space::world;
    std::uint32_t neighbors = 50;
    float beta = 3.0f;
    float free_at = 0.0f;  // value of the descriptor that leaves a photon free …
    float fixed_at = 1.0f; // … and the one that fixes it across
};

enum class RadiusSearch : std::uint32_t {
    exact,   // the (K + 1)-th neighbour's distance
    carried, // the radius of the step before, corrected by the count found in it
};

struct RelaxSettings {
    std::uint32_t steps = 20;
    std::uint32_t neighbors = 6;
    std::array<float, 2> over_relaxation{2.0f, 1.2f}; // λmax, λmin
    float limit = 0.3f;                               // ρ; 0: no migration limiter
    Space repel = Space::world;
    float beta = 3.0f; // of repulsion in parameter space
    RadiusSearch search = RadiusSearch::exact;
    bool diffuse_flux = false;
    std::array<float, 3> period{}; // metres after which space repeats; 0: it does not
    ConstraintSettings constraint;
};

} // namespace photonloupe
