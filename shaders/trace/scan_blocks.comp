// SPDX-License-Identifier: Apache-2.0
// Exclusive prefix sum over the blocks of one chunk, in block order, by one subgroup.
// Inputs: block_sums. Outputs: block_offsets (one more entry than blocks: the last is the chunk's total).
#include "shared/prelude.glsl"
#include "shared/trace.h"
#pragma binding readonly uvec2 block_sums
#pragma binding writeonly uvec2 block_offsets

layout(push_constant) uniform Push { TraceSettings settings; };

void main() {
    uint block_count = (settings.count + PATHS_PER_BLOCK - 1u) / PATHS_PER_BLOCK;
    uvec2 carried = uvec2(0u);
    for (uint first = 0u; first < block_count; first += gl_WorkGroupSize.x) {
        uint block = first + gl_LocalInvocationID.x;
        uvec2 sum = block < block_count ? block_sums[block] : uvec2(0u);
        uvec2 before = sum_before(sum);
        if (block < block_count) block_offsets[block] = carried + before;
        carried += sum_lanes(sum);
    }
    if (gl_LocalInvocationID.x == 0u) block_offsets[block_count] = carried;
}
