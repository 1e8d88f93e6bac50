// SPDX-License-Identifier: Apache-2.0
// The members of photons whose radius is known, a subgroup of photons at a time, one a lane: the tree is walked once and
// every photon within a lane's radius is met with its weight (1, or what photons at just the radius share).
// The kernel includes its candidates first and defines void load_payload(uint position), called with the photon each
// lane holds of a tile, and void meet_member(uint lane, float weight), called for every lane of it.
#include "photons/visit_tiles.glsl"

float member_r2;
float member_tie_weight;
uint map_size; // photons

void load_payload(uint position);
void meet_member(uint lane, float weight);

void visit_tile(uint next, uint end) {
    uint position = next + LANE;
    bool valid = position < end;
    position = min(position, map_size - 1u);
    Candidate mine = load_candidate(position, valid);
    load_payload(position);
    for (uint base = 0u; base < min(WIDTH, TREE_LEAF_PHOTONS); base += 8u) {
#define MEET(c) { float measure = measure_candidate(share_candidate(mine, base + c)); \
        meet_member(base + c, measure < member_r2 ? 1.0 : (measure == member_r2 ? member_tie_weight : 0.0)); }
        MEET(0u) MEET(1u) MEET(2u) MEET(3u) MEET(4u) MEET(5u) MEET(6u) MEET(7u)
    }
}

// Meets the members of every lane's photon.
void stream_members(bool has_query, uint photon_count, uint leaf_level, float r2, float tie_weight) {
    map_size = photon_count;
    member_r2 = has_query ? r2 : -1.0;
    member_tie_weight = tie_weight;
    set_batch(has_query, r2);
    uint depth = leaf_level == 0u ? 0u : 1u;
    uint leaf_count = leaf_level == 0u ? 1u : 0u;
    start_walk();
    do {
        walk_tree(leaf_level, depth, leaf_count);
        visit_leaves(leaf_count, photon_count, leaf_level);
        leaf_count = 0u;
        ++turns;
    } while (depth > 0u && has_turns_left());
}
