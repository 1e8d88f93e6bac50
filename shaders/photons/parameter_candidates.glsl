// SPDX-License-Identifier: Apache-2.0
// Candidates of photons that gather from their own map in parameter space (photons/gather.glsl): set photons of the
// same emitter, by distance of their parameters. The tree is one over the three widest parameters, which stand in
// tree_positions; the distance counts them all.
// Inputs: tree_positions, tree_normals (w emitter as bits), tree_parameters.
#define BOX_ROUNDING (1.0 - 1e-6)
#include "photons/place.glsl"
#include "photons/parameters.glsl"
#pragma binding texel tree_normals

struct Candidate {
    float emitter; // bits
    Parameters parameters;
    uint photon;
};

Candidate my_photon;
Place my_widest;
float my_limit2; // beyond every squared distance
bool am_unset;

Candidate load_candidate(uint position, bool valid) {
    Candidate c;
    c.emitter = valid ? tree_normals_at(position).w : uintBitsToFloat(0xffffffffu);
    c.parameters = load_parameters(position);
    c.photon = floatBitsToUint(tree_positions_at(position).w);
    return c;
}

Candidate share_candidate(Candidate mine, uint lane) {
    Candidate c;
    c.emitter = uintBitsToFloat(subgroupBroadcast(floatBitsToUint(mine.emitter), lane));
    c.parameters = share_parameters(mine.parameters, lane);
    c.photon = subgroupBroadcast(mine.photon, lane);
    return c;
}

Place my_place() { return my_widest; }

float measure_candidate(Candidate other) {
    float measure = measure_parameters(my_photon.parameters, other.parameters);
    bool counts = floatBitsToUint(other.emitter) == floatBitsToUint(my_photon.emitter) && measure < INFINITY;
    return counts ? measure : INFINITY;
}

void set_ranges(bool takes_part) {}
float measure_limit() { return my_limit2; }

float measure_node_gap(Place lo, Place hi, uint node) { return measure_gap(lo, hi, node) * BOX_ROUNDING; }

// Takes the photon at a tree position as the one that gathers.
void take_photon(uint position, vec4 widest_periods, float limit2) {
    set_period(widest_periods);
    load_periods();
    my_photon = load_candidate(position, true);
    my_widest = take_place(tree_positions_at(position));
    my_limit2 = limit2;
    am_unset = is_unset(my_photon.parameters);
}
