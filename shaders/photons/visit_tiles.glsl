// SPDX-License-Identifier: Apache-2.0
// Brings a subgroup of photons, a batch, to all that any of them reaches: walks the tree with the box about the batch
// and visits the photons of every leaf within reach, a subgroup's width (a tile) at a time.
// The kernel includes its candidates first (photons/world_candidates.glsl, photons/parameter_candidates.glsl).
#define LEAF_LIST_SIZE 64u
#include "photons/walk_tree.glsl"

Place batch_lo;
Place batch_hi;
float batch_reach; // squared, the farthest of all lanes

// A box wider than so many reaches is no good bound.
const float SCATTERED_REACHES = 3.0;

// Squared distance from the batch's box to a node's; INFINITY when no lane reaches so far.
float measure_node(uint node) {
    float distance = measure_node_gap(batch_lo, batch_hi, node);
    return distance <= batch_reach ? distance : INFINITY;
}

void set_batch(bool takes_part, float reach2) {
    batch_lo = find_least(my_place(), takes_part);
    batch_hi = find_most(my_place(), takes_part);
    batch_reach = subgroupMax(takes_part ? reach2 : -1.0);
}

// Which of the lanes that search take part in the next walk: all, or, where they lie so scattered that the box about
// them says nothing, the first of them alone.
bool choose_part(bool searching, float reach2) {
    set_batch(searching, reach2);
    Place extent = batch_hi - batch_lo;
    float widest = SCATTERED_REACHES * SCATTERED_REACHES * max(batch_reach, 0.0);
    if (square_length(extent) <= widest) return searching;
    return searching && LANE == subgroupBallotFindLSB(subgroupBallot(searching));
}

// Defines void NAME(uint leaf_count, uint photon_count, uint leaf_level), which visits all listed leaves: VISIT(next,
// end) gets the tree positions of a tile, the last of its leaf cut off.
#define DEFINE_VISIT(NAME, VISIT) \
void NAME(uint leaf_count, uint photon_count, uint leaf_level) { \
    uint leaf = 0u; \
    bool goes_on = leaf_count > 0u; \
    while (goes_on) { \
        uint j = leaf_list[leaf] - (1u << leaf_level); \
        uint next = find_first_position(photon_count, j, leaf_level); \
        uint end = find_first_position(photon_count, j + 1u, leaf_level); \
        do { \
            ++turns; \
            VISIT(next, end); \
            next += WIDTH; \
        } while (next < end); \
        ++turns; \
        ++leaf; \
        goes_on = leaf < leaf_count; \
    } \
    synchronize(); \
}
