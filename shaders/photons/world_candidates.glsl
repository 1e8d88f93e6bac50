// SPDX-License-Identifier: Apache-2.0
// Candidates of photons that gather from their own map in world space (photons/gather.glsl): the same surface
// (METHODS §2), and, with PARAMETER_COUNT, the same emitter and a parameter within reach (METHODS §4); photons without
// parameters are a layer of their own. With FLAT_AXES all lie in one plane and share a normal: no test is needed.
// Inputs: tree_positions, tree_normals (w emitter as bits), tree_parameters, parameter_reach (squared β·r_q).
#include "photons/place.glsl"
#include "photons/same_surface.glsl"
#pragma binding texel tree_normals
#ifdef PARAMETER_COUNT
#include "photons/parameters.glsl"
#pragma binding readonly float parameter_reach
#endif

struct Candidate {
    Place place;
#ifndef FLAT_AXES
    vec3 normal;
#endif
#ifdef PARAMETER_COUNT
    float emitter; // bits
    Parameters parameters;
#endif
};

Candidate my_photon;
vec3 my_normal;
float my_flatness;
#ifdef PARAMETER_COUNT
float my_reach2;
bool am_unset;
#endif

Candidate load_candidate(uint position, bool valid) {
    Candidate c;
    c.place = valid ? take_place(tree_positions_at(position)) : FAR_PLACE;
#if !defined(FLAT_AXES) || defined(PARAMETER_COUNT)
    vec4 normal = tree_normals_at(position);
#endif
#ifndef FLAT_AXES
    c.normal = normal.xyz;
#endif
#ifdef PARAMETER_COUNT
    c.emitter = normal.w;
    c.parameters = load_parameters(position);
#endif
    return c;
}

Candidate share_candidate(Candidate mine, uint lane) {
    Candidate c;
    c.place = share_place(mine.place, lane);
#ifndef FLAT_AXES
    for (int axis = 0; axis < 3; ++axis) c.normal[axis] = subgroupBroadcast(mine.normal[axis], lane);
#endif
#ifdef PARAMETER_COUNT
    c.emitter = uintBitsToFloat(subgroupBroadcast(floatBitsToUint(mine.emitter), lane));
    c.parameters = share_parameters(mine.parameters, lane);
#endif
    return c;
}

Place my_place() { return my_photon.place; }

// From this photon to the other.
Place find_offset(Candidate other) { return wrap_offset(other.place - my_photon.place); }

float measure_candidate(Candidate other) {
    Place d = find_offset(other);
#ifdef FLAT_AXES
    float measure = square_length(d);
#else
    float measure = measure_on_surface(d, my_normal, other.normal, my_flatness);
#endif
#ifdef PARAMETER_COUNT
    bool same_layer = am_unset ? is_nan(other.parameters.q[0])
                               : measure_parameters(my_photon.parameters, other.parameters) <= my_reach2;
    bool same_emitter = floatBitsToUint(other.emitter) == floatBitsToUint(my_photon.emitter);
    measure = same_layer && same_emitter ? measure : INFINITY;
#endif
    return measure;
}

float measure_node_gap(Place lo, Place hi, uint node) { return measure_gap(lo, hi, node); }

// Beyond this no candidate is.
float measure_limit() {
    Place lo = take_place(tree_nodes_at(2u));
    Place hi = take_place(tree_nodes_at(3u));
    Place span = max(abs(my_photon.place - lo), abs(hi - my_photon.place));
#ifdef FLAT_AXES
    return square_length(span) * 1.0001;
#else
    return limit_measure(square_length(span), my_flatness) * 1.0001;
#endif
}

// Takes the photon at a tree position as the one that gathers.
void take_photon(uint position, vec4 space_period, float flatness) {
    set_period(space_period);
    my_photon = load_candidate(position, true);
    my_normal = tree_normals_at(position).xyz;
    my_flatness = flatness;
#ifdef PARAMETER_COUNT
    load_periods();
    am_unset = is_nan(my_photon.parameters.q[0]);
    my_reach2 = parameter_reach[position];
#endif
}
