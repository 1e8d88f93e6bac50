// SPDX-License-Identifier: Apache-2.0
// A list in shared memory of the photons found for one query, as a subgroup keeps it: measure, break_tie() and id, all as
// bits, in no order; cut back to the smallest by all three whenever it has grown.

layout(constant_id = 1) const uint LIST_CAPACITY = 256u; // rank, what it may grow by, and a leaf; engine/photons/gather.cpp

shared uvec3 list[LIST_CAPACITY];

void synchronize() {
    subgroupMemoryBarrierShared();
    subgroupBarrier();
}

void distribute(uvec3 entry, bool valid, uvec3 pivot, bool inclusive, inout uint left, inout uint right) {
    bool below = valid && (is_before(entry, pivot) || (inclusive && entry == pivot));
    bool above = valid && !below;
    uvec2 below_ballot = find_lanes(below);
    uvec2 above_ballot = find_lanes(above);
    uint above_count = count_lanes(above_ballot);
    if (below) list[left + count_before(below_ballot)] = entry;
    if (above) list[right - above_count + count_before(above_ballot)] = entry;
    left += count_lanes(below_ballot);
    right -= above_count;
}

// In-place partition of list[first, end), a subgroup's width at a time (see photons/build_tree.comp).
uint split_range(uint first, uint end, uvec3 pivot, bool inclusive) {
    uint left = first, right = end, read_left = first, read_right = end;
    uvec3 held_left = uvec3(0u), held_right = uvec3(0u);
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
        uvec3 entry = uvec3(0u);
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

uvec3 choose_pivot(uint first, uint end, uint split) {
    uint n = end - first;
    uvec3 sampled = list[first + (LANE * n + n / 2u) / WIDTH];
    uint rank = 0u;
    for (uint other = 0u; other < WIDTH; ++other) rank += uint(is_before(share_entry(sampled, other), sampled));
    float wanted = float(split - first) / float(n) * float(WIDTH);
    float miss = abs(float(rank) + 0.5 - wanted);
    uint winner = find_first_lane(find_lanes(miss == find_least(miss)));
    return share_entry(sampled, winner);
}

// The largest of list[0, count).
uvec3 find_last(uint count) {
    uvec3 last = uvec3(0u);
    turns += count / WIDTH + 1u;
    for (uint i = LANE; i < count; i += WIDTH) last = is_before(last, list[i]) ? list[i] : last;
    uvec3 largest;
    largest.x = find_most(last.x);
    largest.y = find_most(last.x == largest.x ? last.y : 0u);
    largest.z = find_most(last.x == largest.x && last.y == largest.y ? last.z : 0u);
    return largest;
}

// Puts the `rank` smallest of list[0, count) first, in any order, and returns the largest among them.
uvec3 cut_list(uint count, uint rank) {
    uint first = 0u, end = count;
    while (first < rank && rank < end) {
        turns += WIDTH + 4u;
        uvec3 pivot = choose_pivot(first, end, rank);
        uint middle = split_range(first, end, pivot, false);
        if (middle == first) middle = split_range(first, end, pivot, true); // the pivot was the smallest
        if (middle <= rank) first = middle;
        else end = middle;
    }
    return find_last(min(rank, count));
}
