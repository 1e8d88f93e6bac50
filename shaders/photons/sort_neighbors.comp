// SPDX-License-Identifier: Apache-2.0
// Puts the members of each query in order, nearest first, ties by photon id, a run of RUN a lane, by a network in
// registers. Where one run is all (define IS_WHOLE) it is the answer; photons/merge_neighbors.comp merges several.
// Defines: RUN, SORT_NETWORK(DO): its comparators DO(i, j), EACH_OF_RUN(DO): DO(0u) … DO(RUN - 1), EACH_PAIR_OF_RUN(DO):
// half as many. Inputs: found_lists (found_neighbors, as it was before), found_counts. Output: found_neighbors (rows of
// ROW_STRIDE pairs), or what photons/neighbor_results.glsl says.
#include "shared/prelude.glsl"
#include "photons/neighbor_results.glsl"
#pragma binding writeonly uvec2 found_neighbors

uvec2 pair[RUN];

#define LOAD(i) { vec4 two = found_lists_at(min(texel + i, end)); \
    pair[2u * i] = 2u * i < count ? floatBitsToUint(two.xy) : NOBODY; \
    pair[2u * i + 1u] = 2u * i + 1u < count ? floatBitsToUint(two.zw) : NOBODY; }
#define EXCHANGE(i, j) { bool swap = is_before(pair[j], pair[i]); uvec2 least = swap ? pair[j] : pair[i]; \
    pair[j] = swap ? pair[i] : pair[j]; pair[i] = least; }

void main() {
    uint runs = (settings.k + RUN - 1u) / RUN;
    uint i = gl_GlobalInvocationID.x / runs;
    if (i >= settings.count) return;
    uint first = gl_GlobalInvocationID.x % runs * RUN;
    uint row = find_list(i) + first;
    uint count = get_count(i) - min(get_count(i), first);
    uint texel = row / 2u, end = (row + max(count, 1u) - 1u) / 2u;
    EACH_PAIR_OF_RUN(LOAD)
    SORT_NETWORK(EXCHANGE)
#ifdef IS_WHOLE
    uint result = find_result(i);
#define WRITE(i) if (i < settings.k) write_result(result + i, pair[i]);
    EACH_OF_RUN(WRITE)
#else
#define STORE(i) if (i < count) found_neighbors[row + i] = pair[i];
    EACH_OF_RUN(STORE)
#endif
}
