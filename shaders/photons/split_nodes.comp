// SPDX-License-Identifier: Apache-2.0
// Splits nodes about the median of (coordinate, photon id), one a subgroup.
// Inputs: source, range_rows, scales. Outputs: target, tree_nodes. Define: RANGE_ROWS.
#include "shared/prelude.glsl"
#include "photons/tree_source.glsl"
#include "photons/select_key.glsl"
#include "photons/choose_axis.glsl"

// Each shrinks the distance of values, then of places, to a quarter at least.
const uint MOST_PASSES = 26u;

void main() {
    uint node = build.first + gl_WorkGroupID.x;
    if (gl_WorkGroupID.x >= build.count) return;
    uint heap = (1u << build.level) + node;
    uint first = find_first_position(build.photon_count, node, build.level);
    uint end = find_first_position(build.photon_count, node + 1u, build.level);
    uint split = find_first_position(build.photon_count, 2u * node + 1u, build.level + 1u);
    uint axis = choose_axis_of(heap, first, end - first);
    Key pivot = find_ranked(Search(first, end, axis, split - first, int(first), int(end)), MOST_PASSES);
    Halves halves = start_halves();
    uint left = first, right = split;
    move_photons(first, end, axis, pivot, left, right, halves);
    halves = join_halves(halves);
    if (LANE == 0u) {
        write_split(heap, read_key(pivot.value), axis);
        write_children(heap, halves);
    }
}
