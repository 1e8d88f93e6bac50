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

// Apart, so that no index is computed from two.
uint rows_x[LARGEST_BAND + 2u], rows_y[LARGEST_BAND + 2u], rows_z[LARGEST_BAND + 2u], rows_w[LARGEST_BAND + 2u];

// The rows in which a curve meets four lines, in the band from `low` to `high`.
uvec4 find_rows(vec4 c, vec4 u, float low, float high) {
    precise vec4 y = ((c.x * u + c.y) * u + c.z) * u + c.w;
    return uvec4(clamp(y, low, high) - low);
}

// Curves begin and end under a closed axis where their photon lies on it. Beyond, they stay above the image.
uvec4 find_ragged_rows(vec4 c, vec2 extent, vec4 u, vec4 border, float low, float high) {
    uvec4 covers = uvec4(greaterThan(vec4(extent.y), border)) * uvec4(lessThan(vec4(extent.x), border + 1.0));
    return find_rows(c, clamp(u, extent.x, extent.y), low, high) * covers;
}

void clear_counts() {
    for (uint row = 0u; row < settings.row_count + 2u; ++row) rows_x[row] = rows_y[row] = rows_z[row] = rows_w[row] = 0u;
}

void store_count(uint at, uint count) { crossings[at] += uvec2(count & 0xffffu, count >> 16); }

void store_counts(uint part, uint job) {
    for (uint row = 0u; row < settings.row_count + 2u; ++row) {
        uint at = (part * (settings.row_count + 2u) + row) * settings.job_count + job;
        store_count(at, rows_x[row]);
        store_count(at + 1u, rows_y[row]);
        store_count(at + 2u, rows_z[row]);
        store_count(at + 3u, rows_w[row]);
    }
}

void main() {
    uint part = gl_GlobalInvocationID.x / settings.group_count;
    if (part >= settings.part_count) return;
    uint job = (settings.first_group + gl_GlobalInvocationID.x % settings.group_count) * JOBS_PER_GROUP;
    clear_counts();
    uint base = jobs[job].gap * settings.curve_count;
    uint first = min(settings.first_curve + part * settings.part_size, settings.end_curve);
    uint end = min(first + settings.part_size, settings.end_curve);
    vec4 u = vec4(jobs[job].u, jobs[job + 1u].u, jobs[job + 2u].u, jobs[job + 3u].u);
#ifdef RAGGED
    vec4 border = vec4(jobs[job].first, jobs[job + 1u].first, jobs[job + 2u].first, jobs[job + 3u].first);
#endif
    float low = float(settings.first_row), high = float(settings.first_row + settings.row_count + 1u);
    for (uint i = base + first; i < base + end; ++i) {
        vec4 c = curves_at(i);
        uint unit = (floatBitsToUint(c.x) & 1u) != 0u ? RISING_UNIT : 1u;
#ifdef RAGGED
        uvec4 found = find_ragged_rows(c, extents_at(i).xy, u, border, low, high);
#else
        uvec4 found = find_rows(c, u, low, high);
#endif
        rows_x[found.x] += unit;
        rows_y[found.y] += unit;
        rows_z[found.z] += unit;
        rows_w[found.w] += unit;
    }
    store_counts(part, job);
}
