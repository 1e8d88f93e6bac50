// SPDX-License-Identifier: Apache-2.0
// Walks the kd-tree with a whole subgroup: eight descendants tested at once, one a lane, those reached kept nearest
// first, and the leaves among them listed for whoever streams their photons.
// The kernel defines `float measure_node(uint node)`, the squared distance to the node, INFINITY when it is not wanted,
// and LEAF_LIST_SIZE, the leaves that may wait (one step of the walk adds up to TREE_FANOUT).
// Inputs: tree_nodes (2 texels a node), tree_positions (xyz, w photon id).
#include "photons/tree_texels.glsl"
#include "shared/turns.glsl"

#define WIDTH gl_WorkGroupSize.x
#define LANE gl_LocalInvocationID.x

shared uint stack_node[TREE_STACK_SIZE];
shared uint leaf_list[LEAF_LIST_SIZE];

float measure_node(uint node);

void synchronize() {
    subgroupMemoryBarrierShared();
    subgroupBarrier();
}

// Puts the root where the walk begins; a tree of one leaf has nothing to walk.
void start_walk() {
    synchronize();
    if (LANE == 0u) {
        stack_node[0] = 1u;
        leaf_list[0] = 1u;
    }
    synchronize();
}

// Tests up to eight descendants of a node, one a lane; those reached go to the stack, nearest on top, or, when leaves,
// to their list, nearest first.
void step_down(uint node, uint leaf_level, inout uint depth, inout uint leaf_count) {
    uint level = find_level(node);
    uint step = min(TREE_STEP_LEVELS, leaf_level - level);
    uint child = (node << step) + min(LANE, (1u << step) - 1u);
    float distance = measure_node(child);
    bool mine = distance < INFINITY && LANE < (1u << step);
    distance = mine ? distance : INFINITY;
    uint nearer = 0u;
#define RANK(j) { float other = subgroupBroadcast(distance, j); \
    nearer += uint(other < distance || (other == distance && j < LANE)); }
    RANK(0u) RANK(1u) RANK(2u) RANK(3u) RANK(4u) RANK(5u) RANK(6u) RANK(7u)
    uint added = subgroupBallotBitCount(subgroupBallot(mine));
    bool is_leaf = level + step == leaf_level;
    if (mine && is_leaf) leaf_list[leaf_count + nearer] = child;
    if (mine && !is_leaf) stack_node[depth + added - 1u - nearer] = child;
    leaf_count += is_leaf ? added : 0u;
    depth += is_leaf ? 0u : added;
    synchronize();
}

// Walks down until the stack is empty or the leaf list could overflow.
void walk_tree(uint leaf_level, inout uint depth, inout uint leaf_count) {
    while (depth > 0u && leaf_count + TREE_FANOUT <= LEAF_LIST_SIZE) {
        --depth;
        turns += 2u + WIDTH / 8u;
        uint node = stack_node[depth];
        synchronize();
        step_down(node, leaf_level, depth, leaf_count);
    }
}
