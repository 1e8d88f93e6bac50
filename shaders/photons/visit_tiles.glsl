// SPDX-License-Identifier: Apache-2.0
// Brings a subgroup of photons, a batch, to all that any of them reaches: walks the tree with the box about the batch
// and visits the photons of every leaf within reach, a subgroup's width (a tile) at a time.
// Eight descendants are tested at once, one a lane; which of them remain to be entered is a byte for each step down,
// kept in registers: on processors without branches shared memory would cost more than all the rest.
// The kernel includes its candidates first (photons/world_candidates.glsl, photons/parameter_candidates.glsl).
#include "photons/tree_texels.glsl"
#include "shared/turns.glsl"

#define WIDTH gl_WorkGroupSize.x
#define LANE gl_LocalInvocationID.x

// A box wider than so many reaches is no good bound.
const float SCATTERED_REACHES = 10.0;

Place batch_lo;
Place batch_hi;
float batch_reach; // squared, the farthest of all lanes

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
    batch_lo = find_least(my_place(), takes_part);
    batch_hi = find_most(my_place(), takes_part);
    batch_reach = subgroupMax(takes_part ? reach2 : -1.0);
    set_ranges(takes_part);
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

uint get_waiting(uint step) { return (walk.waiting[step >> 2u] >> (8u * (step & 3u))) & 0xffu; }

void set_waiting(uint step, uint flags) {
    uint shift = 8u * (step & 3u);
    uvec3 changed = (walk.waiting & ~uvec3(0xffu << shift)) | uvec3(flags << shift);
    walk.waiting = mix(walk.waiting, changed, equal(uvec3(step >> 2u), uvec3(0u, 1u, 2u)));
}

// The descendants of the present node that the batch reaches.
uint test_descendants() {
    uint levels = walk.step == 0u ? walk.first_levels : TREE_STEP_LEVELS;
    uint child = (walk.node << levels) + min(LANE, (1u << levels) - 1u);
    bool reached = measure_node_gap(batch_lo, batch_hi, child) <= batch_reach && LANE < (1u << levels);
    return subgroupBallot(reached).x;
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
    bool goes_on = walk.leaves == 0u && is_waiting();
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
        goes_on = walk.leaves == 0u && is_waiting();
    }
}

// Defines void NAME(uint photon_count, uint leaf_level), which visits the leaves of the present node: VISIT(next, end)
// gets the tree positions of a tile, the last of its leaf cut off.
#define DEFINE_VISIT(NAME, VISIT) \
void NAME(uint photon_count, uint leaf_level) { \
    uint levels = walk.step == 0u ? walk.first_levels : TREE_STEP_LEVELS; \
    uint base = (walk.node << levels) - (1u << leaf_level); \
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
