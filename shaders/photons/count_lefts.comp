// SPDX-License-Identifier: Apache-2.0
// Large nodes, step 4 of 5: how many photons of each part go to the left half.
// Inputs: source, range_rows, brackets. Output: left_counts. Define: RANGE_ROWS.
#include "shared/prelude.glsl"
#include "photons/large_nodes.glsl"

void main() {
    Part part = find_part();
    uint axis = brackets[part.node].axis;
    Key pivot = get_lo(part.node);
    uint lefts = 0u;
    for (uint i = part.first + LANE; i < part.end; i += WIDTH) lefts += uint(is_less(read_source(i, axis), pivot));
    lefts = sum_lanes(lefts);
    if (LANE == 0u) left_counts[gl_WorkGroupID.x] = lefts;
}
