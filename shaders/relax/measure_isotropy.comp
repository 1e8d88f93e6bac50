// SPDX-License-Identifier: Apache-2.0
// Axis ratio of the world positions of each photon's k neighbours in parameter space ([SJL15] eq. 5).
// Inputs: a tree over parameters (photons/parameter_candidates.glsl), position_emitter and normal_index (by photon id).
// Outputs: axis_ratios (by photon id; NaN: none), unanswered. gather.flatness bounds all squared distances.
#include "shared/prelude.glsl"
#include "shared/math.glsl"
#include "photons/parameter_candidates.glsl"
#include "relax/eigen.glsl"
#pragma binding texel position_emitter
#pragma binding readonly vec4 normal_index

vec3 my_position;
vec3 my_tangent;
vec3 my_bitangent;

float member_sum;
vec2 offset_sum;
vec3 square_sum; // xx, xy, yy

void clear_sums() {
    member_sum = 0.0;
    offset_sum = vec2(0.0);
    square_sum = vec3(0.0);
}

void accumulate(Candidate other, float weight) {
    vec3 d = position_emitter_at(other.photon).xyz - my_position;
    vec2 e = vec2(dot(my_tangent, d), dot(my_bitangent, d));
    vec2 w = weight * e;
    member_sum += other.photon == my_photon.photon ? 0.0 : weight;
    offset_sum += w;
    square_sum += vec3(w.x * e.x, w.x * e.y, w.y * e.y);
}

#include "photons/gather.glsl"
#include "photons/each_photon.glsl"
#include "photons/count_coincident.glsl"
#pragma binding writeonly float axis_ratios

layout(push_constant) uniform Push { GatherSettings settings; };

float find_ratio() {
    vec2 mean = offset_sum / member_sum;
    vec3 squares = square_sum / member_sum;
    float size = max(squares.x, squares.z);
    if (!(size > 0.0)) return uintBitsToFloat(0x7fc00000u);
    Eigen e = decompose((squares.x - mean.x * mean.x) / size, (squares.y - mean.x * mean.y) / size,
                        (squares.z - mean.y * mean.y) / size);
    return e.first > 0.0 ? sqrt(e.second / e.first) : uintBitsToFloat(0x7fc00000u);
}

void main() {
    for (uint batch = 0u; batch < BATCH_COUNT(settings); ++batch) {
        uint position;
        bool has_photon = take_turn(settings, batch, position);
        take_photon(position, settings.period, settings.flatness);
        my_position = position_emitter_at(my_photon.photon).xyz;
        build_basis(normal_index[my_photon.photon].xyz, my_tangent, my_bitangent);
        float guess2 = guess_radius2(settings.photon_count, settings.leaf_level, position, settings.k);
        bool coincide = has_coincident(guess2 == 0.0, position, settings.photon_count, settings.k);
        bool has_query = has_photon && !am_unset && !coincide;
        gather_members(has_query, settings.photon_count, settings.leaf_level, settings.k, guess2);
        bool has_ratio = has_query && my_gathered.others > 1u && my_gathered.r2 > 0.0;
        if (has_photon) {
            axis_ratios[my_photon.photon] = has_ratio ? find_ratio() : uintBitsToFloat(0x7fc00000u);
        }
        report_turn(settings, has_photon, has_turns_left(), position);
    }
}
