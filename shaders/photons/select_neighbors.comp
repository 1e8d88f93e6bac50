// SPDX-License-Identifier: Apache-2.0
// The k nearest photons of each query, nearest first, ties by photon id; missing ones are -1 and inf. Define SPACE.
// Inputs: queries (xyz, w id of a photon to leave out), query_order (the order that visits the tree coherently).
// Outputs: neighbor_ids, neighbor_distances (row q: query q), unanswered (1: the turns did not suffice).
#include "shared/prelude.glsl"
#include "photons/query_layers.glsl"
#include "photons/select_nearest.glsl"
#pragma binding readonly vec4 queries
#pragma binding readonly uint query_order
#pragma binding writeonly int neighbor_ids
#pragma binding writeonly float neighbor_distances
#pragma binding writeonly uint unanswered

layout(push_constant) uniform Push { NeighborQuery settings; };

uint get_map_size() { return settings.photon_count; }

Query current_query;

bool measure_photon(uint position, vec4 photon, out float measure) {
    measure = measure_candidate(current_query, load_candidate(position));
    return measure < INFINITY;
}

// Bitonic sort of list[0, count), padded to the next power of two.
void sort_list(uint count) {
    uint padded = 1u;
    while (padded < count) padded <<= 1u;
    for (uint i = count + LANE; i < padded; i += WIDTH) list[i] = uvec2(0xffffffffu, 0xffffffffu);
    synchronize();
    for (uint size = 2u; size <= padded; size <<= 1u)
        for (uint gap = size >> 1u; gap > 0u; gap >>= 1u) {
            turns += padded / (2u * WIDTH) + 2u;
            for (uint pair = LANE; pair < padded / 2u; pair += WIDTH) {
                uint low = 2u * gap * (pair / gap) + pair % gap;
                uvec2 a = list[low];
                uvec2 b = list[low + gap];
                bool ascending = (low & size) == 0u;
                bool swap = a.x == b.x ? (a.x != 0xffffffffu && is_before(b, a) == ascending && a.y != b.y)
                                       : (b.x < a.x) == ascending;
                if (swap) {
                    list[low] = b;
                    list[low + gap] = a;
                }
            }
            synchronize();
        }
}

void answer_query(uint query) {
    current_query = load_query(query, queries[query], settings.exclude_self != 0u);
    float bound;
    uint count = find_smallest(current_query.point, settings.photon_count, settings.leaf_level, settings.k, bound);
    sort_list(count);
    turns += settings.k / WIDTH + 1u;
    if (LANE == 0u) unanswered[query] = uint(!has_turns_left());
    for (uint i = LANE; i < settings.k; i += WIDTH) {
        uvec2 entry = list[min(i, max(count, 1u) - 1u)];
        uint at = query * settings.k + i;
        neighbor_ids[at] = i < count ? int(find_photon_id(entry.y)) : -1;
        neighbor_distances[at] = i < count ? sqrt(uintBitsToFloat(entry.x)) : INFINITY;
    }
}

void main() {
    set_period(settings.period);
#if SPACE != 0
    load_periods();
#endif
    for (uint i = 0u; i < settings.batches; ++i) {
        uint at = gl_WorkGroupID.x * settings.batches + i;
        if (at >= settings.count) return;
        answer_query(query_order[settings.first + at]);
    }
}
