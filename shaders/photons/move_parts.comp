// SPDX-License-Identifier: Apache-2.0
// Large nodes, step 5 of 5: the photons of each part go to their halves, whose boxes are widened.
// Inputs: source, range_rows, brackets, left_counts. Outputs: target, box_keys. Define: RANGE_ROWS.
#include "shared/prelude.glsl"
#include "photons/large_nodes.glsl"
#include "photons/box_keys.glsl"

void main() {
    Part part = find_part();
    if (brackets[part.node].is_settled == 0u) return; // without its median halves would not fit
    uint begin = find_first_position(build.photon_count, part.node, build.level);
    uint lefts = 0u;
    for (uint i = part.node * build.parts + LANE; i < gl_WorkGroupID.x; i += WIDTH) lefts += left_counts[i];
    lefts = sum_lanes(lefts);
    uint left = begin + lefts;
    uint right = find_split(part.node) + (part.first - begin) - lefts;
    Halves halves = start_halves();
    move_photons(part.first, part.end, brackets[part.node].axis, get_lo(part.node), left, right, halves);
    widen_box(2u * part.node, halves.left_lo, halves.left_hi);
    widen_box(2u * part.node + 1u, halves.right_lo, halves.right_hi);
}
