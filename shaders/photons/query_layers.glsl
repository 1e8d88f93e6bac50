// SPDX-License-Identifier: Apache-2.0
// Whom a neighbour query may find, and how far they count as being: define SPACE (shared/photons.h), and unless it is
// SPACE_WORLD what photons/parameters.glsl needs; LAYER_RANGES where the layer is given by ranges.
// Inputs: query_parameters (rows of each query; ranges: the lower ends), query_layers (x emitter as bits, y squared
// reach), range_ends (rows: the upper ends), tree_normals (w emitter as bits).
#if SPACE == 1
#define BOX_ROUNDING (1.0 - 1e-6)
#endif
#include "photons/place.glsl"
#include "photons/tree_texels.glsl"
#if SPACE != 0
#include "photons/parameters.glsl"
#pragma binding readonly vec4 query_parameters
#pragma binding readonly vec4 query_layers
#pragma binding readonly vec4 range_ends
#pragma binding texel tree_normals
#endif

const uint NOBODY = 0xffffffffu;

struct Query {
    vec3 point;
    uint self; // photon left out
#if SPACE != 0
    uint emitter;
    float reach2;
    bool is_unset;
    Parameters parameters;
#ifdef LAYER_RANGES
    Parameters ends;
#endif
#endif
};

struct Candidate {
    vec3 point;
    uint id;
#if SPACE != 0
    uint emitter;
    Parameters parameters;
#endif
};

#if SPACE != 0
Parameters unpack_rows(uint index, bool is_end) {
    Parameters p;
#ifdef LAYER_RANGES
#define UNPACK_PARAMETER(i) p.q[i] = is_end ? range_ends[i / 4][i % 4] : query_parameters[i / 4][i % 4];
#else
#define UNPACK_PARAMETER(i) p.q[i] = query_parameters[PARAMETER_ROWS * index + i / 4][i % 4];
#endif
    EACH_PARAMETER(UNPACK_PARAMETER)
    return p;
}
#endif

Query load_query(uint index, vec4 given, bool exclude_self) {
    Query query;
    query.point = given.xyz;
    query.self = exclude_self ? floatBitsToUint(given.w) : NOBODY;
#if SPACE != 0
    vec4 layer = query_layers[index];
    query.emitter = floatBitsToUint(layer.x);
    query.reach2 = layer.y;
    query.parameters = unpack_rows(index, false);
    query.is_unset = is_unset(query.parameters);
#ifdef LAYER_RANGES
    query.ends = unpack_rows(index, true);
#endif
#endif
    return query;
}

uint get_map_size();

// Lanes without a candidate read scratch that nobody wrote: by address no descriptor would stop them.
Candidate load_candidate(uint position) {
    position = min(position, get_map_size() - 1u);
    Candidate candidate;
    vec4 photon = tree_positions_at(position);
    candidate.point = photon.xyz;
    candidate.id = floatBitsToUint(photon.w);
#if SPACE != 0
    candidate.emitter = floatBitsToUint(tree_normals_at(position).w);
    candidate.parameters = load_parameters(position);
#endif
    return candidate;
}

Candidate share_candidate(Candidate mine, uint lane) {
    Candidate c;
    c.point = vec3(subgroupBroadcast(mine.point.x, lane), subgroupBroadcast(mine.point.y, lane),
                   subgroupBroadcast(mine.point.z, lane));
    c.id = subgroupBroadcast(mine.id, lane);
#if SPACE != 0
    c.emitter = subgroupBroadcast(mine.emitter, lane);
    c.parameters = share_parameters(mine.parameters, lane);
#endif
    return c;
}

#if SPACE == 2
bool is_in_layer(Query query, Candidate candidate) {
#ifdef LAYER_RANGES
    bool inside = true;
    // A range that ends before it begins goes over the seam.
#define TEST_RANGE(i) { float q = candidate.parameters.q[i]; \
        bool above = q >= query.parameters.q[i], below = q <= query.ends.q[i]; \
        inside = inside && (query.parameters.q[i] <= query.ends.q[i] ? above && below : above || below); }
    EACH_PARAMETER(TEST_RANGE)
    return inside;
#else
    bool is_near = measure_parameters(query.parameters, candidate.parameters) <= query.reach2;
    return candidate.emitter == query.emitter && (query.is_unset ? is_unset(candidate.parameters) : is_near);
#endif
}
#endif

// Squared distance; INFINITY for photons the query must not find.
float measure_candidate(Query query, Candidate candidate) {
#if SPACE == 1
    float measure = measure_parameters(query.parameters, candidate.parameters);
    bool counts = measure < INFINITY && (query.emitter == ANY_EMITTER || query.emitter == candidate.emitter);
#else
    precise vec3 d = candidate.point - query.point;
    precise float measure = d.x * d.x + d.y * d.y + d.z * d.z;
#if SPACE == 2
    bool counts = is_in_layer(query, candidate);
#else
    bool counts = true;
#endif
#endif
    return counts && candidate.id != query.self ? measure : INFINITY;
}
