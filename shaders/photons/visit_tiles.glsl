// SPDX-License-Identifier: Apache-2.0
// Brings a subgroup of photons, a batch, to all that any of them reaches: walks the tree with the box about the batch
// and visits the photons of every leaf within reach, a subgroup's width (a tile) at a time.
// The kernel includes its candidates first (photons/world_candidates.glsl, photons/parameter_candidates.glsl) and
// defines void visit_tile(uint next, uint end), called with the tree positions of a tile, the last of its leaf cut off.
#define LEAF_LIST_SIZE 64u
#include "photons/walk_tree.glsl"

Place batch_lo;
Place batch_hi;
float batch_reach; // squared, the farthest of all lanes
float lane_reach;  // squared, of this lane; negative: it does not search
bool is_scattered; // the batch's box is large against its reach: lanes are looked at one by one

// A box wider than so many reaches is no good bound.
const float SCATTERED_REACHES = 3.0;

void visit_tile(uint next, uint end);

// Squared distance from the batch's box to a node's, or from the nearest lane; INFINITY when no lane reaches so far.
float measure_node(uint node) {
    float distance = measure_node_gap(batch_lo, batch_hi, node);
    distance = distance <= batch_reach ? distance : INFINITY;
    float nearest = INFINITY;
    for (uint lane = 0u; lane < (is_scattered ? WIDTH : 0u); ++lane) {
        Place point = share_place(my_place(), lane);
        float gap = measure_node_gap(point, point, node);
        nearest = gap <= subgroupBroadcast(lane_reach, lane) ? min(nearest, gap) : nearest;
    }
    return is_scattered ? nearest : distance;
}

// Lanes that do not search have no part in the box.
void set_batch(bool searching, float reach2) {
    batch_lo = find_least(my_place(), searching);
    batch_hi = find_most(my_place(), searching);
    lane_reach = searching ? reach2 : -1.0;
    batch_reach = subgroupMax(lane_reach);
    Place extent = batch_hi - batch_lo;
    is_scattered = square_length(extent) > SCATTERED_REACHES * SCATTERED_REACHES * max(batch_reach, 0.0);
}

// Visits all listed leaves.
void visit_leaves(uint leaf_count, uint photon_count, uint leaf_level) {
    uint leaf = 0u;
    bool goes_on = leaf_count > 0u;
    while (goes_on) {
        uint j = leaf_list[leaf] - (1u << leaf_level);
        uint next = find_first_position(photon_count, j, leaf_level);
        uint end = find_first_position(photon_count, j + 1u, leaf_level);
        do {
            ++turns;
            visit_tile(next, end);
            next += WIDTH;
        } while (next < end);
        ++turns;
        ++leaf;
        goes_on = leaf < leaf_count;
    }
    synchronize();
}
