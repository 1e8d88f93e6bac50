// SPDX-License-Identifier: Apache-2.0
// Irradiance in W/m² from the k nearest photons on the same surface (METHODS §2); w: what photons that each carry
// 1 W would give. A photon counts within radius r when
// n_i·n > 0.7, d_i ≤ r and |n·(x_i - x)| ≤ flatness·r: its measure is the smallest such r, squared.
// Inputs: the tree, tree_normals, power_object (by photon id), query_points, query_normals (a zero normal: no query),
// query_order. Outputs: irradiance, unanswered (1: the turns did not suffice).
// Define KERNEL.
#include "shared/prelude.glsl"
#include "estimate/density.glsl"
#include "photons/same_surface.glsl"

struct Query {
    vec3 point;
    vec3 normal;
};

struct Candidate {
    vec3 point;
    vec3 normal;
    uint id;
};

float measure_candidate(Query query, Candidate candidate);
Candidate load_candidate(uint position);
Candidate share_candidate(Candidate mine, uint lane);
float measure_limit(Query query, float distance2);

#include "photons/stream_nearest.glsl"
#pragma binding texel tree_normals
#pragma binding readonly vec4 power_object
#pragma binding readonly vec4 query_points
#pragma binding readonly vec4 query_normals
#pragma binding readonly uint query_order
#pragma binding writeonly vec4 irradiance
#pragma binding writeonly uint unanswered

layout(push_constant) uniform Push { NeighborQuery settings; };

// Lanes without a candidate read scratch that nobody wrote: by address no descriptor would stop them.
Candidate load_candidate(uint position) {
    position = min(position, settings.photon_count - 1u);
    vec4 photon = tree_positions_at(position);
    return Candidate(photon.xyz, tree_normals_at(position).xyz, floatBitsToUint(photon.w));
}

Candidate share_candidate(Candidate mine, uint lane) {
    return Candidate(vec3(subgroupBroadcast(mine.point.x, lane), subgroupBroadcast(mine.point.y, lane),
                          subgroupBroadcast(mine.point.z, lane)),
                     vec3(subgroupBroadcast(mine.normal.x, lane), subgroupBroadcast(mine.normal.y, lane),
                          subgroupBroadcast(mine.normal.z, lane)), subgroupBroadcast(mine.id, lane));
}

float measure_candidate(Query query, Candidate candidate) {
    return measure_on_surface(candidate.point - query.point, query.normal, candidate.normal, settings.flatness);
}

float measure_limit(Query query, float distance2) {
    return limit_measure(distance2, settings.flatness);
}

// Squared radius of the estimate: the (k + 1)-th photon's measure; the farthest's when there are no more.
float find_radius2(uint wanted) {
    float last = measure_candidate(my_query, load_candidate(find_photon(max(min(my_search.count, wanted), 1u) - 1u)));
    bool is_short = my_search.count < wanted;
    return is_short && KERNEL != 1 ? last * BEYOND_FARTHEST * BEYOND_FARTHEST : last;
}

vec4 sum_flux(uint used, float r2) {
    vec4 sum = vec4(0.0);
    for (uint rank = 0u; rank < settings.k; ++rank) {
        bool valid = rank < used;
        Candidate photon = load_candidate(find_photon(valid ? rank : 0u));
        vec3 d = photon.point - my_query.point;
        vec4 power = vec4(power_object[photon.id].rgb, 1.0);
        sum += valid ? power * weigh_photon(min(dot(d, d) / r2, 1.0)) : vec4(0.0);
    }
    return sum;
}

vec4 estimate(uint wanted) {
    uint used = min(my_search.count, settings.k);
    float r = max(sqrt(find_radius2(wanted)), find_spacing(my_query.point));
    vec4 flux = sum_flux(used, r * r);
    if (KERNEL == 1) flux *= float(max(used, 1u) - 1u) / float(max(used, 1u)); // disc: (k - 1)/k is unbiased
    return used > 0u ? spread_flux(flux, r) : vec4(0.0);
}

void main() {
    uint wanted = KERNEL == 1 ? settings.k : settings.k + 1u;
    float guess2 = settings.guess2;
    uint first = gl_WorkGroupID.x * WIDTH * settings.batches;
    for (uint batch = 0u; batch < settings.batches; ++batch) {
        uint turn = first + batch * WIDTH + LANE;
        uint query = query_order[settings.first + min(turn, settings.count - 1u)];
        my_query = Query(query_points[query].xyz, query_normals[query].xyz);
        bool has_query = turn < settings.count && my_query.normal != vec3(0.0);
        find_smallest(has_query, settings.photon_count, settings.leaf_level, wanted, guess2);
        turns += settings.k + 1u;
        vec4 found = estimate(wanted);
        if (turn < settings.count) {
            irradiance[query] = has_query ? found : vec4(0.0);
            unanswered[query] = uint(has_query && !has_turns_left());
        }
        float reached = my_search.count >= wanted ? find_radius2(wanted) : 0.0;
        guess2 = reached > 0.0 ? reached * GUESS_SLACK : settings.guess2;
    }
}
