// SPDX-License-Identifier: Apache-2.0
// The members of queries whose radius is known (photons/find_radii.comp), a subgroup of queries at a time, one a lane:
// the tree is walked once and every photon of the tiles within reach is met with its weight: 1 for members, 0 for
// others; of photons at just the radius, where they share what is left of the rank, a part. A photon meets itself.
// The kernel defines void accumulate(Candidate other, float weight), EACH_SUM(DO), the calls DO(variable) for all that it
// sums in, and where other photons bring more along (define HAS_PAYLOAD) void load_payload(Candidate mine, uint position) for the
// photon a lane holds of a tile, and void meet_payload(uint lane, float weight). CUT_TIES: see photons/find_radii.comp.
// In and out: saved_walks (with SINGLY: a walk that is not over, and the sums so far).
#ifdef CUT_TIES
#define HAS_CUTS
#endif
#include "photons/visit_tiles.glsl"
#pragma binding coherent uint saved_walks

float member_r2;
vec4 member_radius; // as photons/find_radii.comp wrote it
uint member_map_size; // photons

float weigh_member(Candidate other) {
    float measure = measure_candidate(other);
#ifdef CUT_TIES
    uint tie = break_tie(other), cut = floatBitsToUint(member_radius.y);
    bool ties = measure == member_r2 && (tie < cut || (tie == cut && other.id < floatBitsToUint(member_radius.z)));
    return measure < member_r2 || ties ? 1.0 : 0.0;
#else
    return measure < member_r2 ? 1.0 : (measure == member_r2 ? member_radius.y : 0.0);
#endif
}

void member_tile(uint next, uint end) {
    uint position = next + LANE;
    bool valid = position < end;
    position = min(position, member_map_size - 1u);
    Candidate mine = load_candidate(position, valid);
#ifdef HAS_PAYLOAD
    load_payload(mine, position);
#define MEET_PAYLOAD(lane, weight) meet_payload(lane, weight);
#else
#define MEET_PAYLOAD(lane, weight)
#endif
    for (uint base = 0u; base < min(WIDTH, TREE_LEAF_PHOTONS); base += 8u) {
#define MEET(c) { Candidate other = share_candidate(mine, base + c); \
        float weight = weigh_member(other); \
        accumulate(other, weight); \
        MEET_PAYLOAD(base + c, weight) }
        MEET(0u) MEET(1u) MEET(2u) MEET(3u) MEET(4u) MEET(5u) MEET(6u) MEET(7u)
    }
}

DEFINE_VISIT(stream_leaves, member_tile)

#ifdef SINGLY
const uint SAVED_WORDS = 32u; // engine/photons/gather.cpp
uint my_slot;

// Goes on where the dispatch before stopped; false where there is nothing to go on with.
bool resume_walk() {
    uint at = SAVED_WORDS * my_slot;
    bool is_resumed = saved_walks[at] != 0u;
    if (is_resumed) {
        walk = Walk(saved_walks[at + 1u], saved_walks[at + 2u], saved_walks[at + 3u], saved_walks[at + 4u],
                    uvec3(saved_walks[at + 5u], saved_walks[at + 6u], saved_walks[at + 7u]), saved_walks[at + 8u]);
        at += 9u;
#define RESTORE(sum) sum = uintBitsToFloat(saved_walks[at++]);
        EACH_SUM(RESTORE)
    }
    return is_resumed;
}

void save_walk() {
    if (LANE != 0u) return;
    uint at = SAVED_WORDS * my_slot;
    saved_walks[at] = 1u;
    saved_walks[at + 1u] = walk.step;
    saved_walks[at + 2u] = walk.node;
    saved_walks[at + 3u] = walk.last_step;
    saved_walks[at + 4u] = walk.first_levels;
    saved_walks[at + 5u] = walk.waiting.x;
    saved_walks[at + 6u] = walk.waiting.y;
    saved_walks[at + 7u] = walk.waiting.z;
    saved_walks[at + 8u] = walk.leaves;
    at += 9u;
#define SAVE(sum) saved_walks[at++] = floatBitsToUint(sum);
    EACH_SUM(SAVE)
}
#else
bool resume_walk() { return false; }
void save_walk() {}
#endif

// Walks on until all is met or the turns are spent.
void meet_leaves(uint photon_count, uint leaf_level) {
    do {
        stream_leaves(photon_count, leaf_level);
        walk_on();
        ++turns;
    } while (!is_walk_over() && has_turns_left());
}

// Meets the members of every lane's query; false where its turns did not suffice.
bool stream_members(GatherSettings gather, bool has_query, vec4 radius) {
    member_map_size = gather.photon_count;
    member_radius = radius;
    lane_reach = member_r2 = has_query ? radius.x : -1.0;
#ifdef CUT_TIES
    // Of photons at just the radius all are members, none, or those up to a cut.
    uvec2 cut = floatBitsToUint(radius.yz);
    bool is_cut = has_query && cut.x != 0xffffffffu && cut != uvec2(0u);
    lane_cut = is_cut ? uvec3(floatBitsToUint(radius.x), cut) : uvec3(0u);
    lane_reach = is_cut ? -1.0 : lane_reach;
#endif
    if (!resume_walk()) start_walk(gather.leaf_level);
    meet_leaves(gather.photon_count, gather.leaf_level);
    if (!is_walk_over()) save_walk();
    return is_walk_over() || !has_query;
}
