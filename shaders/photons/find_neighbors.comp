// SPDX-License-Identifier: Apache-2.0
// The k nearest photons of each query, nearest first, ties by photon id; missing ones are -1 and inf. Define SPACE.
// Inputs: queries (xyz, w id of a photon to leave out), query_order (the order that visits the tree coherently).
// Outputs: neighbor_ids, neighbor_distances (row q: query q), unanswered (1: the turns did not suffice).
#include "shared/prelude.glsl"

#include "photons/query_layers.glsl"

float measure_limit(Query query, float distance2);

#include "photons/stream_nearest.glsl"
#pragma binding readonly vec4 queries
#pragma binding readonly uint query_order
#pragma binding writeonly int neighbor_ids
#pragma binding writeonly float neighbor_distances
#pragma binding writeonly uint unanswered

layout(push_constant) uniform Push { NeighborQuery settings; };

uint get_map_size() { return settings.photon_count; }
float measure_limit(Query query, float distance2) { return SPACE == 1 ? settings.limit2 : distance2; }

// Returns the squared radius that held k, the next batch's guess.
float write_row(uint query) {
    float reached = 0.0;
    for (uint rank = 0u; rank < settings.k; ++rank) {
        bool valid = rank < my_search.count;
        Candidate candidate = load_candidate(find_photon(valid ? rank : 0u));
        reached = valid ? measure_candidate(my_query, candidate) : INFINITY;
        neighbor_ids[query * settings.k + rank] = valid ? int(candidate.id) : -1;
        neighbor_distances[query * settings.k + rank] = sqrt(reached);
    }
    return reached;
}

void main() {
    set_period(settings.period);
#if SPACE != 0
    load_periods();
#endif
    float guess2 = settings.guess2;
    uint first = gl_WorkGroupID.x * WIDTH * settings.batches;
    for (uint batch = 0u; batch < settings.batches; ++batch) {
        uint turn = first + batch * WIDTH + LANE;
        bool has_query = turn < settings.count;
        uint query = query_order[settings.first + min(turn, settings.count - 1u)];
        vec4 given = queries[query];
        my_query = load_query(query, given, settings.exclude_self != 0u);
        find_smallest(has_query, settings.photon_count, settings.leaf_level, settings.k, guess2);
        if (has_query) {
            turns += settings.k + 1u;
            float reached = write_row(query);
            unanswered[query] = uint(!has_turns_left());
            guess2 = reached > 0.0 && reached < INFINITY ? reached * GUESS_SLACK : settings.guess2;
        }
    }
}
