// SPDX-License-Identifier: Apache-2.0
// Sums photons and path vertices over each block of 64 paths and notes every path's offset inside its block.
// Inputs: summaries. Outputs: path_offsets (photons, vertices before this path in its block), block_sums.
#include "shared/prelude.glsl"
#include "shared/trace.h"
#pragma binding readonly PathSummary summaries
#pragma binding writeonly uvec2 path_offsets
#pragma binding writeonly uvec2 block_sums

layout(push_constant) uniform Push { TraceSettings settings; };

void main() {
    uint block = gl_GlobalInvocationID.x;
    uint first = block * PATHS_PER_BLOCK;
    if (first >= settings.count) return;
    uvec2 sum = uvec2(0u);
    for (uint path = first; path < min(first + PATHS_PER_BLOCK, settings.count); ++path) {
        path_offsets[path] = sum;
        sum += uvec2(summaries[path].photon_count, summaries[path].photon_vertex_count);
    }
    block_sums[block] = sum;
}
