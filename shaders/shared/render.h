// SPDX-License-Identifier: Apache-2.0
// What the rendering kernels and the host exchange: camera, chunk of samples, what is summed.
#ifndef PHOTONLOUPE_SHARED_RENDER_H
#define PHOTONLOUPE_SHARED_RENDER_H

#include "shared/types.h"

SHARED_BEGIN

// Camera in map coordinates; `right` and `up` reach from the image's center to its borders at distance 1.
struct CameraFrame {
    vec4 position;
    vec4 right;
    vec4 up;
    vec4 forward;
};

struct EyeSettings {
    CameraFrame camera;
    uint first_sample;  // sample = pixel · samples + index within the pixel
    uint sample_count;  // in this chunk
    uint width;
    uint height;
    uint samples;       // per pixel
    uint seed;
    uint slot_count;    // diffuse hits one sample may have
    uint max_bounces;
    vec4 environment;   // rgb radiance beyond everything that no image says, w the number of lights as bits
    uvec4 media;        // xy: the camera's Media; z: stretches of one sample in media that are kept; w unused
};

// Stretches of eye paths in media meet the photons there.
struct BeamSettings {
    uint first;        // of this dispatch
    uint count;
    uint photon_count;
    uint leaf_level;
};

struct FilmSettings {
    uint first_pixel;
    uint pixel_count;
    uint samples;
    uint slot_count;
    uint sample_count;  // stride between the slots of one sample
    uint light_count;
    uint uses_map;
    uint uses_direct;
    uint uses_emission;
    uint uses_colors;   // false color: of a surface's color only its luminance counts
    uint seed;
    uint beam_count;    // of each sample, in media
};

struct PlotSettings {
    CameraFrame camera;
    uint first;
    uint count;
    uint width;
    uint height;
    float per_mean_flux; // 1 / mean photon flux (largest channel)
    uint pad0;
    uint pad1;
    uint pad2;
};

// Fixed-point unit of the photon plot: integer sums do not depend on the order of additions.
const float PLOT_UNIT = 256.0f;

SHARED_END

#endif
