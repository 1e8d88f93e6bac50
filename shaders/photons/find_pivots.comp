// SPDX-License-Identifier: Apache-2.0
// Large nodes, step 3 of 5: the median among the keys set aside, one subgroup a node; counts the nodes where it is not
// among them, or among too many.
// In and out: brackets (lo becomes the median), candidates. Outputs: tree_nodes (splits), unsettled.
#include "shared/prelude.glsl"
#include "photons/large_nodes.glsl"
#pragma binding coherent uint unsettled

// Blocks of candidates that a subgroup can go through a few times (shared/turns.glsl).
const uint LARGEST_BLOCKS = 8192u;

void main() {
    uint node = gl_WorkGroupID.x;
    TreeBracket bracket = brackets[node];
    uint first = find_first_position(build.photon_count, node, build.level);
    uint rank = find_split(node) - first;
    if (bracket.is_settled != 0u) return;
    if (rank < bracket.below || rank >= bracket.below + bracket.kept || bracket.kept > LARGEST_BLOCKS * WIDTH) {
        if (LANE == 0u) atomicAdd(unsettled[0], 1u);
        return;
    }
    Key pivot = select_candidate(first, bracket.kept, rank - bracket.below);
    if (LANE == 0u) {
        brackets[node].is_settled = 1u;
        brackets[node].lo_hi.xy = uvec2(uint(pivot.value), pivot.place);
        write_split((1u << build.level) + node, read_key(pivot.value), bracket.axis);
    }
}
