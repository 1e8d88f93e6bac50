// SPDX-License-Identifier: Apache-2.0
// Brings a subgroup of queries, a batch, to all that any of them reaches: walks the tree to every leaf that one of its
// queries reaches and visits the photons there, a subgroup's width (a tile) at a time.
// Eight descendants are tested at once, one a lane; which of them remain to be entered is a byte for each step down,
// kept in registers: on processors without branches shared memory would cost more than all the rest.
// Define ONE_QUERY where all lanes have the same query, HAS_CUTS where a query may find only what is before an entry.
#include "photons/tree_texels.glsl"
#include "photons/candidates.glsl"
#include "shared/turns.glsl"

#define WIDTH gl_WorkGroupSize.x
#define LANE gl_LocalInvocationID.x

float lane_reach; // squared, this lane's; negative: it takes no part
#ifdef HAS_CUTS
uvec3 lane_cut; // beside it: what is before this entry (photons/candidates.glsl); 0: nothing
#endif

// Where a walk stands. Steps down take three levels each, but for the first, which takes what is left.
struct Walk {
    uint step;       // of `node`, counted from the root
    uint node;       // heap index
    uint last_step;  // whose descendants are leaves
    uint first_levels;
    uvec3 waiting;   // a byte for each step: descendants that wait to be entered
    uint leaves;     // of `node`, that wait to be visited
};

Walk walk;

uint get_waiting(uint step) { return (walk.waiting[step >> 2u] >> (8u * (step & 3u))) & 0xffu; }

void set_waiting(uint step, uint flags) {
    uint shift = 8u * (step & 3u);
    uvec3 changed = (walk.waiting & ~uvec3(0xffu << shift)) | uvec3(flags << shift);
    walk.waiting = mix(walk.waiting, changed, equal(uvec3(step >> 2u), uvec3(0u, 1u, 2u)));
}

uint get_levels() { return walk.step == 0u ? walk.first_levels : TREE_STEP_LEVELS; }

// The descendants of the present node that some query reaches: a lane tests one of them, against one query after the
// other. Bounds about all queries together would let in far more.
uint test_descendants() {
    uint levels = get_levels();
    Node node = load_node((walk.node << levels) + min(LANE, (1u << levels) - 1u));
    Query own = get_query();
    bool reached = false;
#if defined(SINGLY) || defined(ONE_QUERY)
    reached = bound_measure(own, node) <= broadcast(lane_reach, 0u);
#else
    for (uint base = 0u; base < WIDTH; base += 8u) {
#define TEST(q) reached = reached || bound_measure(share_query(own, base + q), node) <= broadcast(lane_reach, base + q);
        TEST(0u) TEST(1u) TEST(2u) TEST(3u) TEST(4u) TEST(5u) TEST(6u) TEST(7u)
    }
#endif
#ifdef HAS_CUTS
    for (uint q = any_lane(lane_cut.x > 0u || lane_cut.y > 0u || lane_cut.z > 0u) ? 0u : WIDTH; q < WIDTH; ++q)
        reached = reached || is_before(bound_entry(share_query(own, q), node), share_entry(lane_cut, q));
#endif
    return find_lanes(reached && LANE < (1u << levels)).x;
}

void enter_node(uint step, uint node) {
    walk.step = step;
    walk.node = node;
    uint flags = test_descendants();
    bool has_leaves = step == walk.last_step;
    walk.leaves = has_leaves ? flags : 0u;
    set_waiting(step, has_leaves ? 0u : flags);
}

void start_walk(uint leaf_level) {
    uint steps = (leaf_level + TREE_STEP_LEVELS - 1u) / TREE_STEP_LEVELS;
    walk = Walk(0u, 1u, max(steps, 1u) - 1u, leaf_level - TREE_STEP_LEVELS * (max(steps, 1u) - 1u), uvec3(0u), 0u);
    enter_node(0u, 1u);
}

bool is_waiting() { return (walk.waiting.x | walk.waiting.y | walk.waiting.z) != 0u; }

// Goes on to the next node whose descendants are leaves within reach, if there is one.
void walk_on() {
    bool goes_on = walk.leaves == 0u && is_waiting() && has_turns_left();
    while (goes_on) {
        ++turns;
        // The deepest step at which somebody waits.
        uint word = walk.waiting.z != 0u ? 2u : (walk.waiting.y != 0u ? 1u : 0u);
        uint step = 4u * word + uint(findMSB(walk.waiting[word])) / 8u;
        uint flags = get_waiting(step);
        uint parent = step == 0u ? 1u : walk.node >> (TREE_STEP_LEVELS * (walk.step - step));
        uint levels = step == 0u ? walk.first_levels : TREE_STEP_LEVELS;
        set_waiting(step, flags & (flags - 1u));
        enter_node(step + 1u, (parent << levels) + uint(findLSB(flags)));
        goes_on = walk.leaves == 0u && is_waiting() && has_turns_left();
    }
}

bool is_walk_over() { return walk.leaves == 0u && !is_waiting(); }

// Defines void NAME(uint photon_count, uint leaf_level), which visits the leaves of the present node: VISIT(next, end)
// gets the tree positions of a tile, the last of its leaf cut off. Each lane knows where one leaf begins and ends.
#define DEFINE_VISIT(NAME, VISIT) \
void NAME(uint photon_count, uint leaf_level) { \
    uint leaf = (walk.node << get_levels()) - (1u << leaf_level) + min(LANE, TREE_FANOUT - 1u); \
    uint first = find_first_position(photon_count, leaf, leaf_level); \
    uint last = find_first_position(photon_count, leaf + 1u, leaf_level); \
    uint next = broadcast(first, uint(findLSB(walk.leaves)) % TREE_FANOUT); \
    bool goes_on = walk.leaves != 0u; \
    while (goes_on) { \
        turns += 1u + WIDTH / 8u; \
        uint end = broadcast(last, uint(findLSB(walk.leaves))); \
        VISIT(next, end); \
        next += WIDTH; \
        bool is_through = next >= end; \
        walk.leaves = is_through ? walk.leaves & (walk.leaves - 1u) : walk.leaves; \
        next = is_through ? broadcast(first, uint(findLSB(walk.leaves)) % TREE_FANOUT) : next; \
        goes_on = walk.leaves != 0u; \
    } \
}
