// SPDX-License-Identifier: Apache-2.0
// Evens out unequal fluxes (METHODS §3): each photon's becomes the mean of its own and its neighbours', these weighted
// by 1 - d²/r². Inputs: the tree, radii (squared, of the step), tree_power
// (rgb, in tree order). Outputs: diffused_power (rgb), unanswered. The host restores the total.
#include "shared/prelude.glsl"
#include "shared/relax.h"
#include "photons/candidates.glsl"
#pragma binding texel tree_power

vec3 my_power;
vec3 power_sum;
float weight_sum;
vec3 tile_power;
float my_r2;
float candidate_weight;
#define EACH_SUM(DO) DO(power_sum.x) DO(power_sum.y) DO(power_sum.z) DO(weight_sum)

void load_payload(Candidate mine, uint position) { tile_power = tree_power_at(position).rgb; }

// The photon meets itself at weight 1, which is its own share.
void accumulate(Candidate other, float weight) {
    candidate_weight = weight * max(1.0 - square_length(find_offset(other)) / my_r2, 0.0);
}

void meet_payload(uint lane, float weight) {
    vec3 power = share_vector(tile_power, lane);
    power_sum += candidate_weight > 0.0 ? power * candidate_weight : vec3(0.0);
    weight_sum += candidate_weight > 0.0 ? candidate_weight : 0.0;
}

#define HAS_PAYLOAD
#include "photons/stream_members.glsl"
#include "photons/take_turns.glsl"
#pragma binding texel radii
#pragma binding writeonly vec4 diffused_power

layout(push_constant) uniform Push { GatherSettings settings; };

void main() {
    for (uint batch = 0u; batch < BATCH_COUNT(settings); ++batch) {
        uint position;
        bool has_photon = take_turn(settings, batch, position);
        take_query(position, settings.period, settings.flatness);
        my_power = tree_power_at(position).rgb;
        my_r2 = radii_at(position).x;
        power_sum = vec3(0.0);
        weight_sum = 0.0;
        bool is_met = stream_members(settings, has_photon && my_r2 > 0.0, vec4(my_r2, 0.0, 0.0, 0.0));
        if (has_photon && is_met) diffused_power[position] = vec4(weight_sum > 0.0 ? power_sum / weight_sum : my_power, 0.0);
        report_turn(settings, has_photon, is_met, position);
    }
}
