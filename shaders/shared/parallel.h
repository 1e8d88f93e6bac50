// SPDX-License-Identifier: Apache-2.0
// What the kernels of the parallel coordinates and the host exchange: where curves are met, what is summed, colors.
#ifndef PHOTONLOUPE_SHARED_PARALLEL_H
#define PHOTONLOUPE_SHARED_PARALLEL_H

#include "shared/types.h"

SHARED_BEGIN

// A vertical line at which the curves of one gap are met: they are counted by the row they meet it in.
struct CrossingJob {
    float u;     // its place, in pixels from the gap's first column
    float first; // left border of the pixel column it bounds, likewise
    uint gap;
    uint pad;
};

struct CrossingSettings {
    uint first_group; // of JOBS_PER_GROUP jobs
    uint group_count;
    uint job_count;   // of all groups: the stride of the counts
    uint first_row;   // of the band of the image that is counted
    uint row_count;
    uint curve_count; // of the set
    uint first_curve; // of this dispatch
    uint end_curve;
    uint part_size;   // curves one invocation walks
    uint part_count;  // side by side in one dispatch; each has counts of its own
    uint pad0;
    uint pad1;
};

struct CoverageSettings {
    uint width;
    uint first_row;
    uint row_count;
    uint job_count;
    uint part_count;
    uint set; // 0 context, 1 selection
    uint pad0;
    uint pad1;
};

struct BlendSettings {
    vec4 background; // sRGB, premultiplied by its alpha
    uint width;
    uint first_row;  // of the band of the image that is drawn
    uint row_count;
    uint curve_count;
    uint first_curve; // of this dispatch; 0: on the background
    uint end_curve;   // curve_count: then the pixels are written, else the canvas
    uint gap_count;
    float line_width; // pixels
};

struct PixelSettings {
    vec4 background; // sRGB, premultiplied by its alpha
    vec4 context;    // sRGB and opacity of the densest context
    uint pixel_count;
    uint pad0;
    uint pad1;
    uint pad2;
};

// Vertical lines one invocation serves: each curve is read once for all of them.
const uint JOBS_PER_GROUP = 4u;
// Rows of the image one invocation keeps at hand.
const uint LARGEST_BAND = 1024u;
// A part's counts of the curves that rise and of those that fall share one uint. With a turn a curve and two a row an
// invocation also stays within the turns that all its loops together have (shared/turns.glsl), as it does in summing up
// this many parts.
const uint LARGEST_PART = 32768u;
const uint LARGEST_PART_COUNT = 8u;
const uint NO_JOB = 0xffffffffu;

SHARED_END

#endif
