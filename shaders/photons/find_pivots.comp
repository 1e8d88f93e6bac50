// SPDX-License-Identifier: Apache-2.0
// Large nodes, step 3 of 5: the median among the keys set aside, one subgroup a node; counts the nodes where it is not
// among them, or among too many.
// In and out: brackets (lo becomes the median), candidates. Outputs: tree_nodes (splits), unsettled.
#include "shared/prelude.glsl"
#define LISTED
#include "photons/large_nodes.glsl"
#pragma binding coherent uint unsettled

// Blocks of candidates that a subgroup can go through, all passes together, and the least number of passes
// (shared/turns.glsl).
const uint MOST_BLOCKS = 50000u;
const uint LEAST_PASSES = 8u;

void main() {
    uint node = gl_WorkGroupID.x;
    TreeBracket bracket = brackets[node];
    uint first = find_first_position(build.photon_count, node, build.level);
    uint rank = find_split(node) - first;
    if (bracket.is_settled != 0u) return;
    bool is_kept = rank >= bracket.below && rank < bracket.below + bracket.kept;
    uint passes = MOST_BLOCKS / (bracket.kept / WIDTH + 1u);
    uint count = is_kept && passes >= LEAST_PASSES ? bracket.kept : 0u;
    uint end = find_first_position(build.photon_count, node + 1u, build.level);
    Key pivot = GREATEST;
    if (count > 0u)
        pivot = find_ranked(Search(first, first + count, bracket.axis, rank - bracket.below, int(first), int(end)), passes);
    bool is_found = is_less(pivot, GREATEST);
    if (LANE == 0u && !is_found) atomicAdd(unsettled[0], 1u);
    if (LANE == 0u && is_found) {
        brackets[node].is_settled = 1u;
        brackets[node].lo_hi.xy = uvec2(uint(pivot.value), uint(pivot.place));
        write_split((1u << build.level) + node, read_key(pivot.value), bracket.axis);
    }
}
