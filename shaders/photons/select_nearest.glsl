// SPDX-License-Identifier: Apache-2.0
// The k smallest photons by a measure, by one subgroup per query: eight tree nodes tested at once, survivors gathered
// in a list in shared memory that is cut back to k whenever it has grown.
// The kernel defines `bool measure_photon(uint position, vec4 photon, out float measure)`, never below the squared
// distance. Inputs: tree_nodes (2 texels a node), tree_positions (xyz, w photon id).
#include "photons/place.glsl"
#include "photons/tree_texels.glsl"
#include "shared/turns.glsl"

#define WIDTH gl_WorkGroupSize.x
#define LANE gl_LocalInvocationID.x

layout(constant_id = 1) const uint LIST_CAPACITY = 256u; // k, what it may grow by, and one leaf; see size_list()

shared uvec2 list[LIST_CAPACITY];        // x bits of the measure, y tree position
shared uint stack_node[TREE_STACK_SIZE];
shared float stack_distance[TREE_STACK_SIZE];

void synchronize() {
    subgroupMemoryBarrierShared();
    subgroupBarrier();
}

uint find_photon_id(uint position) { return floatBitsToUint(tree_positions_at(position).w); }

// Smaller measure first, ties by photon id.
bool is_before(uvec2 a, uvec2 b) {
    if (a.x != b.x) return a.x < b.x;
    return a.y != b.y && find_photon_id(a.y) < find_photon_id(b.y);
}

void distribute(uvec2 entry, bool valid, uvec2 pivot, bool inclusive, inout uint left, inout uint right) {
    bool below = valid && (is_before(entry, pivot) || (inclusive && entry.y == pivot.y));
    bool above = valid && !below;
    uvec4 below_ballot = subgroupBallot(below);
    uvec4 above_ballot = subgroupBallot(above);
    uint above_count = subgroupBallotBitCount(above_ballot);
    if (below) list[left + subgroupBallotExclusiveBitCount(below_ballot)] = entry;
    if (above) list[right - above_count + subgroupBallotExclusiveBitCount(above_ballot)] = entry;
    left += subgroupBallotBitCount(below_ballot);
    right -= above_count;
}

// In-place partition of list[first, end), a subgroup's width at a time (see photons/build_tree.comp).
uint split_range(uint first, uint end, uvec2 pivot, bool inclusive) {
    uint left = first, right = end, read_left = first, read_right = end;
    uvec2 held_left = uvec2(0u), held_right = uvec2(0u);
    uint left_count = min(WIDTH, read_right - read_left);
    if (LANE < left_count) held_left = list[read_left + LANE];
    read_left += left_count;
    uint right_count = min(WIDTH, read_right - read_left);
    read_right -= right_count;
    if (LANE < right_count) held_right = list[read_right + LANE];
    synchronize();
    while (read_left < read_right) {
        ++turns;
        uint n = min(WIDTH, read_right - read_left);
        bool from_left = read_left - left <= right - read_right;
        if (!from_left) read_right -= n;
        uvec2 entry = uvec2(0u);
        if (LANE < n) entry = list[(from_left ? read_left : read_right) + LANE];
        if (from_left) read_left += n;
        synchronize();
        distribute(entry, LANE < n, pivot, inclusive, left, right);
        synchronize();
    }
    distribute(held_left, LANE < left_count, pivot, inclusive, left, right);
    distribute(held_right, LANE < right_count, pivot, inclusive, left, right);
    synchronize();
    return left;
}

uvec2 choose_pivot(uint first, uint end, uint split) {
    uint n = end - first;
    uvec2 sampled = list[first + (LANE * n + n / 2u) / WIDTH];
    uint rank = 0u;
    for (uint other = 0u; other < WIDTH; ++other)
        rank += uint(subgroupBroadcast(sampled.x, other) < sampled.x);
    float wanted = float(split - first) / float(n) * float(WIDTH);
    float miss = abs(float(rank) + 0.5 - wanted);
    uint winner = subgroupBallotFindLSB(subgroupBallot(miss == subgroupMin(miss)));
    return uvec2(subgroupBroadcast(sampled.x, winner), subgroupBroadcast(sampled.y, winner));
}

// Puts the k smallest of list[0, count) first, in any order, and returns the largest measure among them.
float cut_list(uint count, uint k) {
    uint first = 0u, end = count;
    while (first < k && k < end && has_turns_left()) {
        turns += WIDTH + 4u;
        uvec2 pivot = choose_pivot(first, end, k);
        uint middle = split_range(first, end, pivot, false);
        if (middle == first) middle = split_range(first, end, pivot, true); // the pivot was the smallest
        if (middle <= k) first = middle;
        else end = middle;
    }
    uint largest = 0u;
    turns += k / WIDTH + 1u;
    for (uint i = LANE; i < min(k, count); i += WIDTH) largest = max(largest, list[i].x);
    return uintBitsToFloat(subgroupMax(largest));
}

// Pushes those of the node's descendants, up to three levels down, that may hold something, farthest first.
uint push_descendants(vec3 query, uint node, uint level, uint leaf_level, float bound, uint depth) {
    uint step = min(TREE_STEP_LEVELS, leaf_level - level);
    bool valid = LANE < (1u << step);
    uint child = (node << step) + LANE;
    float distance = valid ? measure_gap(query, query, child) * BOX_ROUNDING : INFINITY;
    valid = valid && distance <= bound;
    uint nearer = 0u; // survivors in front of this one
    for (uint other = 0u; other < TREE_FANOUT; ++other) {
        float theirs = subgroupBroadcast(valid ? distance : INFINITY, other);
        nearer += uint(theirs < distance || (theirs == distance && other < LANE));
    }
    uint count = subgroupBallotBitCount(subgroupBallot(valid));
    if (valid) {
        stack_node[depth + count - 1u - nearer] = child;
        stack_distance[depth + count - 1u - nearer] = distance;
    }
    synchronize();
    return depth + count;
}

bool measure_photon(uint position, vec4 photon, out float measure);

// Appends a leaf's photons within the bound to the list.
uint gather_leaf(uint first, uint end, float bound, uint count) {
    for (uint base = first; base < end; base += WIDTH) {
        turns += 2u;
        uint position = base + LANE;
        float measure = 0.0;
        bool valid = position < end && measure_photon(position, tree_positions_at(min(position, end - 1u)), measure);
        valid = valid && measure <= bound;
        uvec4 ballot = subgroupBallot(valid);
        if (valid) list[count + subgroupBallotExclusiveBitCount(ballot)] = uvec2(floatBitsToUint(measure), position);
        count += subgroupBallotBitCount(ballot);
    }
    synchronize();
    return count;
}

// Leaves the k smallest photons of the tree in list[0, returned count), unordered; `bound` becomes their largest measure.
// Without turns left at the end the result is not to be trusted.
uint find_smallest(vec3 query, uint photon_count, uint leaf_level, uint k, out float bound) {
    bound = INFINITY;
    uint count = 0u;
    uint full = k + max(k / 4u, TREE_LEAF_PHOTONS / 2u); // cut back when the list has grown past this
    uint depth = 1u;
    synchronize(); // the previous query of this workgroup may still be reading the list
    if (LANE == 0u) {
        stack_node[0] = 1u;
        stack_distance[0] = 0.0;
    }
    synchronize();
    while (depth > 0u && has_turns_left()) {
        --depth;
        turns += TREE_FANOUT + 3u;
        if (stack_distance[depth] > bound) continue;
        uint node = stack_node[depth];
        uint level = find_level(node);
        synchronize();
        if (level < leaf_level) {
            depth = push_descendants(query, node, level, leaf_level, bound, depth);
            continue;
        }
        uint j = node - (1u << level);
        count = gather_leaf(find_first_position(photon_count, j, level),
                            find_first_position(photon_count, j + 1u, level), bound, count);
        if (count >= full || (count >= k && bound == INFINITY)) {
            bound = cut_list(count, k);
            count = min(count, k);
        }
    }
    if (count >= k) bound = cut_list(count, k);
    return min(count, k);
}
