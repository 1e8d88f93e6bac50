// SPDX-License-Identifier: Apache-2.0
// Brings a subgroup of queries, a batch, to all that any of them reaches: walks the tree with the bounds of the batch
// and visits the photons of every leaf that one of its queries reaches, a subgroup's width (a tile) at a time.
// Eight descendants are tested at once, one a lane; which of them remain to be entered is a byte for each step down,
// kept in registers: on processors without branches shared memory would cost more than all the rest.
#include "photons/tree_texels.glsl"
#include "photons/candidates.glsl"
#include "shared/turns.glsl"

#define WIDTH gl_WorkGroupSize.x
#define LANE gl_LocalInvocationID.x

// A box wider than so many reaches is no good bound.
const float SCATTERED_REACHES = 10.0;

Bounds batch;
float batch_reach; // squared, the farthest of all lanes
float lane_reach;  // squared, this lane's; negative: it takes no part

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

void set_batch(bool takes_part, float reach2) {
    batch = join_bounds(bound_mine(), takes_part);
    lane_reach = takes_part ? reach2 : -1.0;
    batch_reach = subgroupMax(lane_reach);
}

// Which of the lanes that search take part in the next walk: all, or, where they lie so scattered that the box about
// them says nothing, the first of them alone.
bool choose_part(bool searching, float reach2) {
    set_batch(searching, reach2);
    float widest = SCATTERED_REACHES * SCATTERED_REACHES * max(batch_reach, 0.0);
    if (measure_extent(batch) <= widest) return searching;
    return searching && LANE == subgroupBallotFindLSB(subgroupBallot(searching));
}

uint get_waiting(uint step) { return (walk.waiting[step >> 2u] >> (8u * (step & 3u))) & 0xffu; }

void set_waiting(uint step, uint flags) {
    uint shift = 8u * (step & 3u);
    uvec3 changed = (walk.waiting & ~uvec3(0xffu << shift)) | uvec3(flags << shift);
    walk.waiting = mix(walk.waiting, changed, equal(uvec3(step >> 2u), uvec3(0u, 1u, 2u)));
}

uint get_levels() { return walk.step == 0u ? walk.first_levels : TREE_STEP_LEVELS; }

// The descendants of the present node that the batch reaches.
uint test_descendants() {
    uint levels = get_levels();
    uint child = (walk.node << levels) + min(LANE, (1u << levels) - 1u);
    bool reached = bound_measure(batch, child) <= batch_reach && LANE < (1u << levels);
    return subgroupBallot(reached).x;
}

// Of those, leaves that no query reaches by itself are left out: a batch's bounds are wider than all of them.
uint choose_leaves(uint flags) {
    uint first = walk.node << get_levels();
    Bounds own = bound_mine();
    uint kept = 0u, left = flags;
    while (left != 0u) {
        ++turns;
        uint bit = uint(findLSB(left));
        left &= left - 1u;
        kept |= subgroupAny(bound_measure(own, first + bit) <= lane_reach) ? 1u << bit : 0u;
    }
    return kept;
}

void enter_node(uint step, uint node) {
    walk.step = step;
    walk.node = node;
    uint flags = test_descendants();
    bool has_leaves = step == walk.last_step;
    walk.leaves = choose_leaves(has_leaves ? flags : 0u);
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
// gets the tree positions of a tile, the last of its leaf cut off.
#define DEFINE_VISIT(NAME, VISIT) \
void NAME(uint photon_count, uint leaf_level) { \
    uint base = (walk.node << get_levels()) - (1u << leaf_level); \
    uint j = base + uint(findLSB(walk.leaves)); \
    uint next = find_first_position(photon_count, j, leaf_level); \
    bool goes_on = walk.leaves != 0u; \
    while (goes_on) { \
        turns += 1u + WIDTH / 8u; \
        uint end = find_first_position(photon_count, j + 1u, leaf_level); \
        VISIT(next, end); \
        next += WIDTH; \
        bool is_through = next >= end; \
        walk.leaves = is_through ? walk.leaves & (walk.leaves - 1u) : walk.leaves; \
        j = base + uint(findLSB(walk.leaves)); \
        next = is_through ? find_first_position(photon_count, j, leaf_level) : next; \
        goes_on = walk.leaves != 0u; \
    } \
}
