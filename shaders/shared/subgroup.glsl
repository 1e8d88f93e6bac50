// SPDX-License-Identifier: Apache-2.0
// What the lanes of a subgroup tell each other, all by shuffles between lanes that are known beforehand. On processors a
// shuffle is one instruction, while the built-in votes, reductions and broadcasts are loops over the lanes, a broadcast of
// some fifty instructions. All lanes must be active: what an inactive one holds is undefined.
// SUBGROUP_SIZE is a specialisation constant of the device, a power of two from 8 to 64.
layout(constant_id = 63) const uint SUBGROUP_SIZE = 8u;

#define broadcast(x, lane) subgroupShuffle(x, lane)

// Defines T NAME(T x), which folds the x of all lanes; `combined` is made of x and `other`.
#define DEFINE_FOLD(T, NAME, combined) T NAME(T x) { \
    T other = subgroupShuffleXor(x, 1u); x = combined; \
    other = subgroupShuffleXor(x, 2u); x = combined; \
    other = subgroupShuffleXor(x, 4u); x = combined; \
    if (SUBGROUP_SIZE > 8u) { other = subgroupShuffleXor(x, 8u); x = combined; } \
    if (SUBGROUP_SIZE > 16u) { other = subgroupShuffleXor(x, 16u); x = combined; } \
    if (SUBGROUP_SIZE > 32u) { other = subgroupShuffleXor(x, 32u); x = combined; } \
    return x; }

DEFINE_FOLD(float, find_least, min(x, other))
DEFINE_FOLD(uint, find_least, min(x, other))
DEFINE_FOLD(float, find_most, max(x, other))
DEFINE_FOLD(uint, find_most, max(x, other))
DEFINE_FOLD(float, sum_lanes, x + other)
DEFINE_FOLD(uint, sum_lanes, x + other)
DEFINE_FOLD(uvec2, sum_lanes, x + other)
DEFINE_FOLD(vec3, sum_lanes, x + other)
DEFINE_FOLD(vec4, sum_lanes, x + other)
DEFINE_FOLD(uint, join_bits, x | other)

bool any_lane(bool b) { return join_bits(uint(b)) != 0u; }
bool all_lanes(bool b) { return join_bits(uint(!b)) == 0u; }

// Sum of the lanes before this one. Float sums add in the same order on every device of one width.
#define DEFINE_SUM_BEFORE(T) T sum_before(T x) { \
    T sum = x; \
    for (uint step = 1u; step < SUBGROUP_SIZE; step <<= 1u) { \
        T other = subgroupShuffle(sum, (gl_SubgroupInvocationID - step) & (SUBGROUP_SIZE - 1u)); \
        sum += gl_SubgroupInvocationID >= step ? other : T(0); \
    } \
    T before = subgroupShuffle(sum, (gl_SubgroupInvocationID - 1u) & (SUBGROUP_SIZE - 1u)); \
    return gl_SubgroupInvocationID > 0u ? before : T(0); }

DEFINE_SUM_BEFORE(uint)
DEFINE_SUM_BEFORE(uvec2)
DEFINE_SUM_BEFORE(vec3)

// The lanes for which b holds, a bit each.
uvec2 find_lanes(bool b) {
    uint lane = gl_SubgroupInvocationID;
    uvec2 lanes = uvec2(join_bits(b && lane < 32u ? 1u << (lane & 31u) : 0u), 0u);
    if (SUBGROUP_SIZE > 32u) lanes.y = join_bits(b && lane >= 32u ? 1u << (lane & 31u) : 0u);
    return lanes;
}

uint count_lanes(uvec2 lanes) { return SUBGROUP_SIZE > 32u ? uint(bitCount(lanes.x) + bitCount(lanes.y)) : uint(bitCount(lanes.x)); }

// Of those, the ones before this lane.
uint count_before(uvec2 lanes) {
    uint lane = gl_SubgroupInvocationID;
    uint before = (1u << (lane & 31u)) - 1u;
    bool is_upper = lane >= 32u;
    uint count = uint(bitCount(lanes.x & (is_upper ? 0xffffffffu : before)));
    if (SUBGROUP_SIZE > 32u) count += uint(bitCount(lanes.y & (is_upper ? before : 0u)));
    return count;
}

// The first of them; meaningless for none.
uint find_first_lane(uvec2 lanes) {
    return SUBGROUP_SIZE > 32u && lanes.x == 0u ? 32u + uint(findLSB(lanes.y)) : uint(findLSB(lanes.x));
}
