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
#pragma binding texel tree_ranges // with TREE_RANGES: of nodes, see engine/photons/layered_tree.h
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
const float RANGE_ROUNDING = 1e-6;
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
    c.normal = vec3(subgroupBroadcast(mine.normal.x, lane), subgroupBroadcast(mine.normal.y, lane),
                    subgroupBroadcast(mine.normal.z, lane));
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
#ifdef PERIODIC
    measure = other.place.x < FAR_BOUND ? measure : INFINITY; // wrapped, a far place may be near
#endif
#ifdef PARAMETER_COUNT
    bool same_layer = am_unset ? is_nan(other.parameters.q[0])
                               : measure_parameters(my_photon.parameters, other.parameters) <= my_reach2;
    bool same_emitter = floatBitsToUint(other.emitter) == floatBitsToUint(my_photon.emitter);
    measure = same_layer && same_emitter ? measure : INFINITY;
#endif
    return measure;
}

#ifdef TREE_RANGES
// What the batch's photons may find: layer numbers and the parameters that the tree is over.
vec4 range_lo;
vec4 range_hi;

// Widened by the reach, and a little, for what rounding may do to differences.
void set_ranges(bool takes_part) {
    float layer = 2.0 * float(floatBitsToUint(my_photon.emitter)) + (am_unset ? 1.0 : 0.0);
    float reach = am_unset ? INFINITY : sqrt(my_reach2);
    vec4 lo = vec4(layer, vec3(-INFINITY)), hi = vec4(layer, vec3(INFINITY));
    const uint axes[3] = TREE_RANGES; // the parameters' numbers; beyond PARAMETER_COUNT: none
#define SET_RANGE(i) if (axes[i] < PARAMETER_COUNT && reach < INFINITY) { \
        float q = my_photon.parameters.q[min(axes[i], PARAMETER_COUNT - 1u)]; \
        float slack = RANGE_ROUNDING * (abs(q) + reach); \
        lo[i + 1] = q - reach - slack; \
        hi[i + 1] = q + reach + slack; }
    SET_RANGE(0) SET_RANGE(1) SET_RANGE(2)
#define JOIN_RANGE(i) range_lo[i] = subgroupMin(takes_part ? lo[i] : INFINITY); \
    range_hi[i] = subgroupMax(takes_part ? hi[i] : -INFINITY);
    JOIN_RANGE(0) JOIN_RANGE(1) JOIN_RANGE(2) JOIN_RANGE(3)
}

bool is_in_ranges(uint node) {
    return all(lessThanEqual(tree_ranges_at(2u * node), range_hi)) &&
           all(greaterThanEqual(tree_ranges_at(2u * node + 1u), range_lo));
}

float measure_node_gap(Place lo, Place hi, uint node) {
    return is_in_ranges(node) ? measure_gap(lo, hi, node) : INFINITY;
}
#else
void set_ranges(bool takes_part) {}
float measure_node_gap(Place lo, Place hi, uint node) { return measure_gap(lo, hi, node); }
#endif

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
