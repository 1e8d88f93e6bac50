// SPDX-License-Identifier: Apache-2.0
// Axis ratio of the world positions of each photon's k neighbours in parameter space ([SJL15] eq. 5).
// Inputs: a tree over parameters, radii. Outputs: axis_ratios (by photon id; NaN: none), unanswered.
#include "shared/prelude.glsl"
#include "shared/math.glsl"
#include "photons/candidates.glsl"
#include "relax/eigen.glsl"

vec3 my_position;
vec3 my_tangent;
vec3 my_bitangent;

float member_sum;
vec2 offset_sum;
vec3 square_sum; // xx, xy, yy

vec3 tile_position;
#define EACH_SUM(DO) DO(member_sum) DO(offset_sum.x) DO(offset_sum.y) DO(square_sum.x) DO(square_sum.y) DO(square_sum.z)

void accumulate(Candidate other, float weight) {}

void load_payload(Candidate mine, uint position) { tile_position = tree_positions_at(position).xyz; }

// The photon itself adds nothing but to the count.
void meet_payload(uint lane, float weight) {
    vec3 d = share_vector(tile_position, lane) - my_position;
    d = weight > 0.0 ? d : vec3(0.0);
    vec2 e = vec2(dot(my_tangent, d), dot(my_bitangent, d));
    vec2 w = weight * e;
    member_sum += weight;
    offset_sum += w;
    square_sum += vec3(w.x * e.x, w.x * e.y, w.y * e.y);
}

#define HAS_PAYLOAD
#include "photons/stream_members.glsl"
#include "photons/take_turns.glsl"
#pragma binding texel radii
#pragma binding writeonly float axis_ratios

layout(push_constant) uniform Push { GatherSettings settings; };

float find_ratio() {
    float members = member_sum - 1.0; // less the photon itself
    vec2 mean = offset_sum / members;
    vec3 squares = square_sum / members;
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
        take_query(position, settings.period, settings.flatness);
        vec4 point = query_points_at(position);
        my_position = point.xyz;
        build_basis(my_normal, my_tangent, my_bitangent);
        vec4 radius = radii_at(position);
        bool has_ratio = has_photon && radius.w > 1.0 && radius.x > 0.0;
        member_sum = 0.0;
        offset_sum = vec2(0.0);
        square_sum = vec3(0.0);
        bool is_met = stream_members(settings, has_ratio, radius);
        if (has_photon && is_met)
            axis_ratios[floatBitsToUint(point.w)] = has_ratio ? find_ratio() : uintBitsToFloat(0x7fc00000u);
        report_turn(settings, has_photon, is_met, position);
    }
}
