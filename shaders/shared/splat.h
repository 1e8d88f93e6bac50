// SPDX-License-Identifier: Apache-2.0
// What the kernels that draw photons as points and the host exchange.
#ifndef PHOTONLOUPE_SHARED_SPLAT_H
#define PHOTONLOUPE_SHARED_SPLAT_H

#include "shared/render.h"

SHARED_BEGIN

struct SplatSettings {
    CameraFrame camera; // in the surface view's coordinates
    vec4 shift_radius;  // xyz from the map's coordinates to the view's; w radius of a point, pixels
    uint first;
    uint count;
    uint width;
    uint height;
    uint has_marks;     // photons whose mark is 0 are context
    uint has_colors;
    uint has_surface;   // photons behind a surface are hidden
    float unit;         // fixed-point weight of a point's center: no sum of all photons overflows
};

struct ResolveSettings {
    vec4 eye;        // of the surface view
    vec4 background; // sRGB
    vec4 plain;      // sRGB of points without colors
    uint first;
    uint count;
    uint has_marks;
    uint has_colors;
    uint has_surface;
    float unit;
    float strength;  // optical depth of one point's center
    uint pad0;
};

// Sums a pixel has: weight, red, green and blue of the photons marked, then of the others.
const uint SPLAT_SUMS = 8u;
const float SPLAT_UNIT = 64.0f;
// Color sums are of weight times 6-bit channels: 2^32 / (64 · 63) points fit at least.
const float SPLAT_CHANNEL = 63.0f;
const float SPLAT_MOST = 1048576.0f;

SHARED_END

#endif
