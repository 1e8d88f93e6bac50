// SPDX-License-Identifier: Apache-2.0
// Irradiance in W/m² from the k nearest photons on the same surface (METHODS §2); w: what photons that each carry
// 1 W would give. With IN_SPACE the fluence in a medium, from the k nearest in space. Inputs: the tree, the queries (a zero normal: no query), radii (r from the photon behind the k-th; disc:
// from the k-th), power_object (by photon id). Outputs: irradiance, unanswered. Define KERNEL (shared/photons.h).
#include "shared/prelude.glsl"
#include "estimate/density.glsl"
#include "photons/candidates.glsl"

layout(push_constant) uniform Push { GatherSettings settings; };

vec4 flux_sum;
float candidate_weight;
uint tile_photon;
vec3 tile_power;
float radius2;
#define EACH_SUM(DO) DO(flux_sum.x) DO(flux_sum.y) DO(flux_sum.z) DO(flux_sum.w)
#pragma binding texel power_object

void accumulate(Candidate other, float weight) {
    candidate_weight = weight > 0.0 ? weigh_photon(min(square_length(find_offset(other)) / radius2, 1.0)) : 0.0;
}

// By address no descriptor would stop lanes that read nothing sensible.
void load_payload(Candidate mine, uint position) {
    uint photon = min(mine.id, settings.photon_count - 1u);
    tile_power = power_object_at(photon).rgb;
}

void meet_payload(uint lane, float weight) {
    vec3 power = share_vector(tile_power, lane);
    flux_sum += candidate_weight > 0.0 ? vec4(power, 1.0) * candidate_weight : vec4(0.0);
}

#define HAS_PAYLOAD
#include "photons/stream_members.glsl"
#include "photons/take_turns.glsl"
#pragma binding texel radii
#pragma binding readonly uint result_rows
#pragma binding writeonly vec4 irradiance

// Queries that stand together (settings.stride, the samples of a pixel) share the radius of the first of them, where they
// lie within this share of it on a surface that faces alike. The others are left unanswered, and asked for themselves.
const float SHARED_DISTANCE = 0.25;
const float SHARED_COSINE = 0.99;

// The radius of the query's group; false where it has nothing to do with this query.
bool take_radius(uint query, out vec4 radius) {
#ifdef IN_SPACE
    radius = radii_at(query);
    return true;
#else
    uint leader = query / settings.stride;
    radius = radii_at(leader);
    if (leader * settings.stride == query) return true;
    vec3 d = query_points_at(leader * settings.stride).xyz - my_place;
    vec3 normal = query_normals_at(leader * settings.stride).xyz;
    float height = dot(my_normal, d) / max(settings.flatness, 1e-20);
    float near2 = max(dot(d, d), settings.flatness > 0.0 ? height * height : 0.0);
    return radius.w == float(settings.rank) && near2 <= SHARED_DISTANCE * SHARED_DISTANCE * radius.x &&
           dot(normal, my_normal) > SHARED_COSINE;
#endif
}

// r: that of a set that takes every photon lies a little beyond the farthest.
float find_support(vec4 radius) {
    bool is_short = radius.w < float(settings.rank) && KERNEL != 1;
    return max(sqrt(radius.x) * (is_short ? BEYOND_FARTHEST : 1.0), find_spacing(my_place));
}

void main() {
    for (uint batch = 0u; batch < BATCH_COUNT(settings); ++batch) {
        uint query;
        bool has_query = take_turn(settings, batch, query);
        take_query(query, settings.period, settings.flatness);
        vec4 radius;
        bool is_asked = has_query && can_find();
        bool has_radius = take_radius(query, radius) || !is_asked;
        radius.w = is_asked && has_radius ? radius.w : 0.0;
        float r = find_support(radius);
        radius2 = r * r;
        flux_sum = vec4(0.0);
        bool is_met = stream_members(settings, has_query && radius.w > 0.0, radius);
        float found = max(radius.w, 1.0);
        if (KERNEL == 1) flux_sum *= (found - 1.0) / found; // disc: (k - 1)/k is unbiased
        if (has_query && is_met && has_radius) irradiance[result_rows[query]] = radius.w > 0.0 ? spread_flux(flux_sum, r) : vec4(0.0);
        report_turn(settings, has_query, is_met && has_radius, query);
    }
}
