// SPDX-License-Identifier: Apache-2.0
// Puts the members of each query in order, nearest first, ties by photon id, a query a lane: runs of RUN are sorted by a
// network in registers, then WAYS runs are merged at a time. Defines: RUN, SORT_NETWORK(DO): its comparators DO(i, j),
// EACH_OF_RUN(DO): DO(0u) … DO(RUN - 1), WAYS, EACH_WAY(DO): DO(0) … DO(WAYS - 1).
// Inputs: found_counts, result_rows (the row of each query's answer). In and out: found_neighbors (rows of `k` pairs;
// behind the last row as much room again). Outputs: neighbor_ids, neighbor_distances; missing ones are -1 and inf.
#include "shared/prelude.glsl"
#include "shared/photons.h"
#pragma binding coherent uvec2 found_neighbors
#pragma binding readonly uint found_counts
#pragma binding readonly uint result_rows
#pragma binding writeonly int neighbor_ids
#pragma binding writeonly float neighbor_distances

layout(push_constant) uniform Push { SortSettings settings; };

const uvec2 NOBODY = uvec2(0xffffffffu);

bool is_before(uvec2 a, uvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

#define EXCHANGE(i, j) { bool swap = is_before(pair[j], pair[i]); uvec2 least = swap ? pair[j] : pair[i]; \
    pair[j] = swap ? pair[i] : pair[j]; pair[i] = least; }

// Sorts one run by Batcher's odd-even merge sort.
void sort_run(uint row, uint first, uint count) {
    uvec2 pair[RUN];
#define LOAD(i) pair[i] = first + i < count ? found_neighbors[row + min(first + i, max(count, 1u) - 1u)] : NOBODY;
#define STORE(i) if (first + i < count) found_neighbors[row + first + i] = pair[i];
    EACH_OF_RUN(LOAD)
    SORT_NETWORK(EXCHANGE)
    EACH_OF_RUN(STORE)
}

uvec2 load_head(uint from, uint at, uint end) { return at < end ? found_neighbors[from + min(at, max(end, 1u) - 1u)] : NOBODY; }

// Merges WAYS runs that begin at `first`.
void merge_runs(uint from, uint to, uint first, uint run, uint count) {
    uvec2 head[WAYS];
    uint at[WAYS];
#define END_OF(w) min(first + (w + 1u) * run, count)
#define START(w) at[w] = min(first + uint(w) * run, count); head[w] = load_head(from, at[w], END_OF(uint(w)));
    EACH_WAY(START)
    uint end = END_OF(WAYS - 1u);
    for (uint out_at = first; out_at < end; ++out_at) {
        uvec2 least = head[0];
        uint way = 0u, next = at[0];
#define COMPARE(w) { bool less = is_before(head[w], least); least = less ? head[w] : least; way = less ? uint(w) : way; \
        next = less ? at[w] : next; }
        EACH_WAY(COMPARE)
        found_neighbors[to + out_at] = least;
        uvec2 loaded = load_head(from, next + 1u, END_OF(way));
#define ADVANCE(w) head[w] = way == uint(w) ? loaded : head[w]; at[w] += uint(way == uint(w));
        EACH_WAY(ADVANCE)
    }
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= settings.count) return;
    uint count = found_counts[settings.first + i - settings.row_first];
    uint from = settings.k * (settings.first + i - settings.row_first);
    uint to = from + settings.room;
    for (uint first = 0u; first < count; first += RUN) sort_run(from, first, count);
    for (uint run = RUN; run < count; run *= WAYS) {
        for (uint first = 0u; first < count; first += run * WAYS) merge_runs(from, to, first, run, count);
        uint swapped = from;
        from = to;
        to = swapped;
    }
    uint row = settings.k * result_rows[settings.first + i];
    for (uint rank = 0u; rank < settings.k; ++rank) {
        bool valid = rank < count;
        uvec2 entry = valid ? found_neighbors[from + rank] : uvec2(0x7f800000u, 0xffffffffu);
        neighbor_ids[row + rank] = int(entry.y);
        neighbor_distances[row + rank] = sqrt(uintBitsToFloat(entry.x));
    }
}
