// SPDX-License-Identifier: Apache-2.0
// Builds levels of the kd-tree: one subgroup takes a node, finds its box and widest axis, and partitions its photons
// in place about the median of (coordinate, photon id) — a total order, so the tree is unique.
// Inputs and outputs: tree_positions (xyz, w photon id). Outputs: tree_nodes.
#include "shared/prelude.glsl"
#include "photons/tree_layout.glsl"
#pragma binding coherent vec4 tree_positions
#pragma binding writeonly TreeNode tree_nodes

layout(push_constant) uniform Push { TreeBuild build; };

#define WIDTH gl_WorkGroupSize.x
#define LANE gl_LocalInvocationID.x

struct Key {
    float value;
    uint id;
};

void synchronize() {
    subgroupMemoryBarrierBuffer();
    subgroupBarrier();
}

float pick_axis(vec4 p, uint axis) { return axis == 0u ? p.x : (axis == 1u ? p.y : p.z); }
bool is_less(float value, uint id, Key pivot) { return value < pivot.value || (value == pivot.value && id < pivot.id); }

void find_box(uint first, uint end, out vec3 lo, out vec3 hi) {
    lo = vec3(INFINITY);
    hi = vec3(-INFINITY);
    for (uint i = first + LANE; i < end; i += WIDTH) {
        vec3 p = tree_positions[i].xyz;
        lo = min(lo, p);
        hi = max(hi, p);
    }
    lo = vec3(subgroupMin(lo.x), subgroupMin(lo.y), subgroupMin(lo.z));
    hi = vec3(subgroupMax(hi.x), subgroupMax(hi.y), subgroupMax(hi.z));
}

// The sample, out of one per lane, whose rank among the samples is nearest to the rank sought.
Key choose_pivot(uint first, uint end, uint split, uint axis) {
    uint n = end - first;
    vec4 p = tree_positions[first + uint((float(LANE) + 0.5) / float(WIDTH) * float(n))];
    float value = pick_axis(p, axis);
    uint id = floatBitsToUint(p.w);
    uint rank = 0u;
    for (uint other = 0u; other < WIDTH; ++other) {
        Key key = Key(subgroupBroadcast(value, other), subgroupBroadcast(id, other));
        rank += uint(is_less(key.value, key.id, Key(value, id)));
    }
    float wanted = float(split - first) / float(n) * float(WIDTH);
    float miss = abs(float(rank) + 0.5 - wanted);
    bool nearest = miss == subgroupMin(miss);
    uint winner = subgroupBallotFindLSB(subgroupBallot(nearest));
    return Key(subgroupBroadcast(value, winner), subgroupBroadcast(id, winner));
}

// Writes the block's members to the free ends: below the pivot to the left, the others to the right.
void distribute(vec4 p, bool valid, uint axis, Key pivot, bool inclusive, inout uint left, inout uint right) {
    uint id = floatBitsToUint(p.w);
    float value = pick_axis(p, axis);
    bool below = valid && (is_less(value, id, pivot) || (inclusive && id == pivot.id));
    bool above = valid && !below;
    uvec4 below_ballot = subgroupBallot(below);
    uvec4 above_ballot = subgroupBallot(above);
    if (below) tree_positions[left + subgroupBallotExclusiveBitCount(below_ballot)] = p;
    uint above_count = subgroupBallotBitCount(above_ballot);
    if (above) tree_positions[right - above_count + subgroupBallotExclusiveBitCount(above_ballot)] = p;
    left += subgroupBallotBitCount(below_ballot);
    right -= above_count;
}

// In-place partition, a subgroup's width at a time: a block held from each end keeps room to write (Bramas 2017).
// Returns the first position that is not below the pivot.
uint split_range(uint first, uint end, uint axis, Key pivot, bool inclusive) {
    uint left = first, right = end;             // next free places
    uint read_left = first, read_right = end;   // unread middle
    vec4 held_left = vec4(0.0), held_right = vec4(0.0);
    uint left_count = min(WIDTH, read_right - read_left);
    if (LANE < left_count) held_left = tree_positions[read_left + LANE];
    read_left += left_count;
    uint right_count = min(WIDTH, read_right - read_left);
    read_right -= right_count;
    if (LANE < right_count) held_right = tree_positions[read_right + LANE];
    synchronize();
    while (read_left < read_right) {
        uint n = min(WIDTH, read_right - read_left);
        bool from_left = read_left - left <= right - read_right; // the end with less room is read first
        if (!from_left) read_right -= n;
        vec4 p = vec4(0.0);
        if (LANE < n) p = tree_positions[(from_left ? read_left : read_right) + LANE];
        if (from_left) read_left += n;
        synchronize();
        distribute(p, LANE < n, axis, pivot, inclusive, left, right);
        synchronize();
    }
    distribute(held_left, LANE < left_count, axis, pivot, inclusive, left, right);
    distribute(held_right, LANE < right_count, axis, pivot, inclusive, left, right);
    synchronize();
    return left;
}

// Orders the photons so that all before `split` are below all from `split` on.
void select_median(uint first, uint end, uint split, uint axis) {
    while (first < split && split < end) {
        Key pivot = choose_pivot(first, end, split, axis);
        uint middle = split_range(first, end, axis, pivot, false);
        if (middle == first) middle = split_range(first, end, axis, pivot, true); // the pivot was the smallest
        if (middle <= split) first = middle;
        else end = middle;
    }
}

void build_node(uint level, uint node) {
    uint first = find_first_position(build.photon_count, node, level);
    uint end = find_first_position(build.photon_count, node + 1u, level);
    vec3 lo, hi;
    find_box(first, end, lo, hi);
    vec3 extent = hi - lo;
    uint axis = extent.x >= extent.y && extent.x >= extent.z ? 0u : (extent.y >= extent.z ? 1u : 2u);
    float split_value = 0.0;
    if (level < build.leaf_level) {
        uint split = find_first_position(build.photon_count, 2u * node + 1u, level + 1u);
        select_median(first, end, split, axis);
        // The first coordinate of the right half (its smallest).
        float smallest = INFINITY;
        for (uint i = split + LANE; i < end; i += WIDTH) smallest = min(smallest, pick_axis(tree_positions[i], axis));
        split_value = subgroupMin(smallest);
    } else {
        axis = 3u;
    }
    if (LANE == 0u) tree_nodes[(1u << level) + node] = TreeNode(vec4(lo, split_value), vec4(hi, uintBitsToFloat(axis)));
}

void main() {
    uint root = build.root_first + gl_WorkGroupID.x;
    if (root >= 1u << build.root_level) return;
    for (uint level = build.root_level; level <= build.last_level; ++level) {
        uint below = level - build.root_level;
        for (uint node = root << below; node < (root + 1u) << below; ++node) build_node(level, node);
    }
}
