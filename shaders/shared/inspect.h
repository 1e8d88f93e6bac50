// SPDX-License-Identifier: Apache-2.0
// What the inspecting kernels and the host exchange: the surfaces a camera sees, and the cells that they fall in.
#ifndef PHOTONLOUPE_SHARED_INSPECT_H
#define PHOTONLOUPE_SHARED_INSPECT_H

#include "shared/render.h"

SHARED_BEGIN

struct SurfaceSettings {
    CameraFrame camera;
    uint first; // pixel
    uint count;
    uint width;
    uint height;
    uint sees_through; // surfaces that mostly transmit are passed, straight on
    uint pad0;
    uint pad1;
    uint pad2;
};

struct CellSettings {
    vec4 shift; // xyz: from the scene's origin to the map's; w unused
    uint first; // pixel
    uint count;
    uint photon_count;
    uint leaf_level;
    uint level;     // nodes: the one they are sought at
    uint turns;     // photons: loop turns before a walk is laid aside
    float flatness; // photons of the same surface: largest height as a share of r; 0: of any surface
    uint pad0;
};

// A walk that met nobody, or a pixel without a surface.
const uint NO_CELL = 0xffffffffu;

SHARED_END

#endif
