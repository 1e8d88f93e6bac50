// SPDX-License-Identifier: Apache-2.0
// Large nodes, step 2 of 5: sets the keys within a node's bracket aside and counts those below it.
// Inputs: source, range_rows. In and out: brackets. Output: candidates. Define: RANGE_ROWS.
#include "shared/prelude.glsl"
#include "photons/large_nodes.glsl"

void main() {
    Part part = find_part();
    if (brackets[part.node].is_settled != 0u) return;
    uint axis = brackets[part.node].axis;
    Key lo = get_lo(part.node), hi = get_hi(part.node);
    uint below = 0u, within = 0u;
    for (uint i = part.first + LANE; i < part.end; i += WIDTH) {
        Key key = read_source(i, axis);
        bool is_low = is_less(key, lo);
        below += uint(is_low);
        within += uint(!is_low && is_less(key, hi));
    }
    below = sum_lanes(below);
    uint kept = 0u;
    uint of_all = sum_lanes(within);
    if (LANE == 0u) {
        atomicAdd(brackets[part.node].below, below);
        kept = atomicAdd(brackets[part.node].kept, of_all); // in any order: the key of a rank is one
    }
    uint to = find_first_position(build.photon_count, part.node, build.level) + broadcast(kept, 0u) +
              sum_before(within);
    for (uint i = part.first + LANE; i < part.end; i += WIDTH) {
        Key key = read_source(i, axis);
        bool is_within = !is_less(key, lo) && is_less(key, hi);
        if (is_within) candidates[to] = i;
        to += uint(is_within);
    }
}
