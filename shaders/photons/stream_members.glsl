// SPDX-License-Identifier: Apache-2.0
// The members of photons whose radius is known, a subgroup of photons at a time, one a lane: the tree is walked once and
// every photon of the tiles within reach is met with its weight: 1 nearer than the radius, what they share at just it,
// else 0. A photon meets itself.
// The kernel includes its candidates first and defines void accumulate(Candidate other, float weight), and where other
// photons bring more along (define HAS_PAYLOAD) void load_payload(uint position) for the photon a lane holds of a tile,
// and void meet_payload(uint lane, float weight).
#include "photons/visit_tiles.glsl"

float member_r2;
float member_tie_weight;
uint member_map_size;

void member_tile(uint next, uint end) {
    uint position = next + LANE;
    bool valid = position < end;
    position = min(position, member_map_size - 1u);
    Candidate mine = load_candidate(position, valid);
#ifdef HAS_PAYLOAD
    load_payload(position);
#define MEET_PAYLOAD(lane, weight) meet_payload(lane, weight);
#else
#define MEET_PAYLOAD(lane, weight)
#endif
    for (uint base = 0u; base < min(WIDTH, TREE_LEAF_PHOTONS); base += 8u) {
#define MEET(c) { Candidate other = share_candidate(mine, base + c); \
        float measure = measure_candidate(other); \
        float weight = measure < member_r2 ? 1.0 : (measure == member_r2 ? member_tie_weight : 0.0); \
        accumulate(other, weight); \
        MEET_PAYLOAD(base + c, weight) }
        MEET(0u) MEET(1u) MEET(2u) MEET(3u) MEET(4u) MEET(5u) MEET(6u) MEET(7u)
    }
}

DEFINE_VISIT(stream_leaves, member_tile)

// Meets the members of every lane's photon.
void stream_members(bool has_query, uint photon_count, uint leaf_level, float r2, float tie_weight) {
    member_map_size = photon_count;
    member_tie_weight = tie_weight;
    bool is_left = has_query;
    do {
        bool takes_part = choose_part(is_left, r2);
        set_batch(takes_part, r2);
        member_r2 = takes_part ? r2 : -1.0;
        start_walk(leaf_level);
        do {
            stream_leaves(photon_count, leaf_level);
            walk_on();
            ++turns;
        } while (walk.leaves != 0u && has_turns_left());
        is_left = is_left && !takes_part;
    } while (subgroupAny(is_left) && has_turns_left());
}
