// SPDX-License-Identifier: Apache-2.0
// Counts in which row of pixels the curves of a gap meet a vertical line, rising and falling curves apart: an
// invocation keeps the counts of JOBS_PER_GROUP lines and walks a part of the curves once.
// Inputs: jobs, curves (coefficients by gap and curve, the image's top at 1, the last bit of x set where the curve
// rises on the screen), with RAGGED extents (first and last u). Output: crossings (falling, rising; by part, row, job).
#include "shared/prelude.glsl"
#include "shared/parallel.h"
#pragma binding readonly CrossingJob jobs
#pragma binding texel curves
#ifdef RAGGED
#pragma binding texel extents
#endif
#pragma binding uvec2 crossings

layout(push_constant) uniform Push { CrossingSettings settings; };

const uint RISING_UNIT = 65536u;

uint rows[JOBS_PER_GROUP][LARGEST_BAND + 2u];

uint find_row(vec4 c, float u) {
    precise float y = ((c.x * u + c.y) * u + c.z) * u + c.w;
    float first = float(settings.first_row);
    return uint(clamp(y, first, first + float(settings.row_count + 1u))) - settings.first_row;
}

// Curves begin and end under a closed axis where their photon lies on it. Beyond, they stay above the image.
uint find_ragged_row(vec4 c, vec2 extent, CrossingJob job) {
    bool covers = extent.y > job.first && extent.x < job.first + 1.0;
    return covers ? find_row(c, clamp(job.u, extent.x, extent.y)) : 0u;
}

void store_counts(uint part, uint job) {
    for (uint row = 0u; row < settings.row_count + 2u; ++row)
        for (uint k = 0u; k < JOBS_PER_GROUP; ++k) {
            uint at = (part * (settings.row_count + 2u) + row) * settings.job_count + job + k;
            crossings[at] += uvec2(rows[k][row] & 0xffffu, rows[k][row] >> 16);
        }
}

void main() {
    uint part = gl_GlobalInvocationID.x / settings.group_count;
    if (part >= settings.part_count) return;
    uint job = (settings.first_group + gl_GlobalInvocationID.x % settings.group_count) * JOBS_PER_GROUP;
    for (uint row = 0u; row < settings.row_count + 2u; ++row)
        for (uint k = 0u; k < JOBS_PER_GROUP; ++k) rows[k][row] = 0u;
    uint base = jobs[job].gap * settings.curve_count;
    uint first = min(settings.first_curve + part * settings.part_size, settings.end_curve);
    uint end = min(first + settings.part_size, settings.end_curve);
    CrossingJob my_jobs[JOBS_PER_GROUP] = CrossingJob[](jobs[job], jobs[job + 1u], jobs[job + 2u], jobs[job + 3u]);
    for (uint i = base + first; i < base + end; ++i) {
        vec4 c = curves_at(i);
        uint unit = (floatBitsToUint(c.x) & 1u) != 0u ? RISING_UNIT : 1u;
#ifdef RAGGED
        vec2 extent = extents_at(i).xy;
        for (uint k = 0u; k < JOBS_PER_GROUP; ++k) rows[k][find_ragged_row(c, extent, my_jobs[k])] += unit;
#else
        for (uint k = 0u; k < JOBS_PER_GROUP; ++k) rows[k][find_row(c, my_jobs[k].u)] += unit;
#endif
    }
    store_counts(part, job);
}
