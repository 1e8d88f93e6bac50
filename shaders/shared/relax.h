// SPDX-License-Identifier: Apache-2.0
// What the relaxation kernels and the host exchange: descriptors, steps, landings.
#ifndef PHOTONLOUPE_SHARED_RELAX_H
#define PHOTONLOUPE_SHARED_RELAX_H

#include "shared/photons.h"

SHARED_BEGIN

// What decides which way a photon may move (METHODS §5).
const uint DESCRIPTOR_NONE = 0u;
const uint DESCRIPTOR_GRADIENT = 1u;
const uint DESCRIPTOR_PCA = 2u;
const uint DESCRIPTOR_TENSOR = 3u;
const uint DESCRIPTOR_SPLIT = 4u;

// One step of relaxation (METHODS §3).
struct RepelSettings {
    GatherSettings gather;
    float tau;     // over-relaxation (2)
    float limiter; // ln 2/ρ² of (5); 0: no limit
    float spacing; // metres: what floats tell apart at the map's largest coordinate
    uint pad0;
};

// A descriptor: its value leaves a photon free at one end of a range and fixes it at the other.
struct DescribeSettings {
    GatherSettings gather;
    float free_at;
    float fixed_at;
    uint pad0;
    uint pad1;
};

// Moving photons and bringing them back to their surface.
struct MoveSettings {
    uint first;
    uint count;
    uint photon_count;
    uint pad0;
};

// Photons one invocation sums over.
const uint SUM_RUN = 256u;

// Photons without a triangle move in their tangent plane.
const uint NO_TRIANGLE = 0x7fffffffu;
const uint BACK_SIDE = 0x80000000u; // the photon lies on the side that clockwise triangles show

SHARED_END

#endif
