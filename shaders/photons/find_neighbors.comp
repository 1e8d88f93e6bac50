// SPDX-License-Identifier: Apache-2.0
// The k nearest photons of each query in world space, nearest first, ties by photon id; missing ones are -1 and inf.
// Inputs: queries (xyz, w id of a photon to leave out), query_order (the order that visits the tree coherently).
// Outputs: neighbor_ids, neighbor_distances (row q: query q), unanswered (1: the turns did not suffice).
#include "shared/prelude.glsl"

struct Query {
    vec3 point;
    uint self; // photon left out
};

struct Candidate {
    vec3 point;
    uint id;
};

const uint NOBODY = 0xffffffffu;

float measure_candidate(Query query, Candidate candidate);
Candidate load_candidate(uint position);
Candidate share_candidate(Candidate mine, uint lane);
float measure_limit(Query query, float distance2) { return distance2; }

#include "photons/stream_nearest.glsl"
#pragma binding readonly vec4 queries
#pragma binding readonly uint query_order
#pragma binding writeonly int neighbor_ids
#pragma binding writeonly float neighbor_distances
#pragma binding writeonly uint unanswered

layout(push_constant) uniform Push { NeighborQuery settings; };

// Lanes without a candidate read scratch that nobody wrote: by address no descriptor would stop them.
Candidate load_candidate(uint position) {
    position = min(position, settings.photon_count - 1u);
    vec4 photon = tree_positions_at(position);
    return Candidate(photon.xyz, floatBitsToUint(photon.w));
}

Candidate share_candidate(Candidate mine, uint lane) {
    return Candidate(vec3(subgroupBroadcast(mine.point.x, lane), subgroupBroadcast(mine.point.y, lane),
                          subgroupBroadcast(mine.point.z, lane)), subgroupBroadcast(mine.id, lane));
}

float measure_candidate(Query query, Candidate candidate) {
    precise vec3 d = candidate.point - query.point;
    precise float distance = d.x * d.x + d.y * d.y + d.z * d.z;
    return candidate.id == query.self ? INFINITY : distance;
}

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
    float guess2 = settings.guess2;
    uint first = gl_WorkGroupID.x * WIDTH * settings.batches;
    for (uint batch = 0u; batch < settings.batches; ++batch) {
        uint turn = first + batch * WIDTH + LANE;
        bool has_query = turn < settings.count;
        uint query = query_order[settings.first + min(turn, settings.count - 1u)];
        vec4 given = queries[query];
        my_query = Query(given.xyz, settings.exclude_self != 0u ? floatBitsToUint(given.w) : NOBODY);
        find_smallest(has_query, settings.photon_count, settings.leaf_level, settings.k, guess2);
        if (has_query) {
            turns += settings.k + 1u;
            float reached = write_row(query);
            unanswered[query] = uint(!has_turns_left());
            guess2 = reached > 0.0 && reached < INFINITY ? reached * GUESS_SLACK : settings.guess2;
        }
    }
}
