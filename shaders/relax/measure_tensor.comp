// SPDX-License-Identifier: Apache-2.0
// The `tensor` descriptor (METHODS §5.3): the structure tensor of normalised offsets g = m/r over each photon and its
// neighbours. Inputs: the tree, offsets and member_radii of relax/measure_moments.comp. Outputs: constraint_along, constraint_across, unanswered.
#include "shared/prelude.glsl"
#include "shared/relax.h"
#include "relax/tangent_plane.glsl"
#include "relax/eigen.glsl"

vec3 tensor_sum; // xx, xy, yy
vec3 tile_offset;
#define EACH_SUM(DO) DO(tensor_sum.x) DO(tensor_sum.y) DO(tensor_sum.z)
#pragma binding texel offsets

void accumulate(Candidate other, float weight) {}

void load_payload(Candidate mine, uint position) { tile_offset = offsets_at(position).xyz; }

void meet_payload(uint lane, float weight) {
    vec2 g = project_vector(share_vector(tile_offset, lane));
    vec2 w = weight * g;
    tensor_sum += vec3(w.x * g.x, w.x * g.y, w.y * g.y);
}

#define HAS_PAYLOAD
#include "photons/stream_members.glsl"
#include "photons/take_turns.glsl"
#include "relax/write_constraint.glsl"
#pragma binding texel member_radii

layout(push_constant) uniform Push { DescribeSettings settings; };

// Mean eigenvalue of noise: the offset of k random photons has variance 1/(4k) along each axis.
const float NOISE = 0.25;

void main() {
    for (uint batch = 0u; batch < BATCH_COUNT(settings.gather); ++batch) {
        uint position;
        bool has_photon = take_turn(settings.gather, batch, position);
        take_query(position, settings.gather.period, settings.gather.flatness);
        set_tangents();
        vec4 found = member_radii_at(position);
        vec4 own = offsets_at(position);
        tensor_sum = vec3(0.0);
        // The photon meets itself among its members, with full weight. All in one place: no offset.
        bool is_met = stream_members(settings.gather, has_photon && found.x > 0.0, found);
        vec3 mean = tensor_sum / (own.w + 1.0);
        Eigen e = decompose(mean.x, mean.y, mean.z);
        float value = own.w > 0.0 ? e.first * own.w / NOISE : 0.0;
        if (has_photon && is_met)
            write_constraint(position, own.w, project_vector(own.xyz), e.axis,
                             ramp(value, settings.free_at, settings.fixed_at));
        report_turn(settings.gather, has_photon, is_met, position);
    }
}
