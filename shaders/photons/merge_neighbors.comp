// SPDX-License-Identifier: Apache-2.0
// Merges the sorted runs of each query's list into its answer, a query a lane. Defines: RUN, RUNS, EACH_RUN(DO): DO(0) …
// DO(RUNS - 1). Inputs and outputs: photons/neighbor_results.glsl.
#include "shared/prelude.glsl"
#include "photons/neighbor_results.glsl"

uvec2 load_head(uint row, uint at, uint end) {
    uint pair = row + min(at, max(end, 1u) - 1u);
    vec4 two = found_lists_at(pair / 2u);
    return at < end ? floatBitsToUint(pair % 2u == 0u ? two.xy : two.zw) : NOBODY;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= settings.count) return;
    uint count = get_count(i), row = find_list(i), result = find_result(i);
    uvec2 head[RUNS];
    uint at[RUNS];
#define START(w) at[w] = min(uint(w) * RUN, count); head[w] = load_head(row, at[w], count);
    EACH_RUN(START)
    for (uint rank = 0u; rank < settings.k; ++rank) {
        uvec2 least = NOBODY;
        uint run = 0u, next = count;
#define COMPARE(w) { bool less = is_before(head[w], least); least = less ? head[w] : least; run = less ? uint(w) : run; \
        next = less ? at[w] + 1u : next; }
        EACH_RUN(COMPARE)
        write_result(result + rank, least);
        uvec2 loaded = load_head(row, next, min((run + 1u) * RUN, count));
#define ADVANCE(w) { bool taken = run == uint(w); head[w] = taken ? loaded : head[w]; at[w] += uint(taken); }
        EACH_RUN(ADVANCE)
    }
}
