// SPDX-License-Identifier: Apache-2.0
// Moments of each photon's neighbours in its tangent plane: gradient and one-sidedness (METHODS §5.1), and the
// descriptors that need no more (§5.2 pca; `gradient`: one-sidedness alone).
// Inputs: the tree, radii. Outputs, tree order: offsets (xyz g = m/r, w neighbours K'), member_radii (x r², y weight of
// photons at just r, z one-sidedness, w axis ratio t), constraint_along (u_b, w_u), constraint_across (v_b, w_v),
// unanswered.
// Define DESCRIPTOR (shared/relax.h).
#include "shared/prelude.glsl"
#include "shared/relax.h"
#include "relax/tangent_plane.glsl"
#include "relax/eigen.glsl"

vec2 offset_sum;
vec3 square_sum; // xx, xy, yy

#define EACH_SUM(DO) DO(offset_sum.x) DO(offset_sum.y) DO(square_sum.x) DO(square_sum.y) DO(square_sum.z)

void accumulate(Candidate other, float weight) {
    vec2 e = project_offset(find_offset(other));
    vec2 w = weight * e;
    offset_sum += w;
    square_sum += vec3(w.x * e.x, w.x * e.y, w.y * e.y);
}

#include "photons/stream_members.glsl"
#include "photons/take_turns.glsl"
#include "relax/write_constraint.glsl"
#pragma binding texel radii
#pragma binding writeonly vec4 offsets
#pragma binding writeonly vec4 member_radii

layout(push_constant) uniform Push { DescribeSettings settings; };

// A half disc's mean offset is 4/(3π) of its radius.
const float HALF_DISC_OFFSET = 0.4244;
// One-sidedness that leaves a photon free, and the one of a sure edge (METHODS §5.2).
const float EDGE_FREE = 0.35;
const float EDGE_FIXED = 0.8;

void describe_photon(uint position, vec4 radius) {
    float members = radius.w > 0.0 ? radius.z : 0.0;
    float r2 = radius.x * (radius.w == 1.0 ? 4.0 : 1.0); // of two photons r is twice their distance
    float r = sqrt(r2);
    bool has_extent = r > 0.0 && members > 0.0;
    // In units of r, so that squares of tiny scenes do not underflow.
    vec2 mean = has_extent ? offset_sum / members / r : vec2(0.0);
    vec3 squares = has_extent ? square_sum / members / r2 : vec3(0.0);
    float one_sidedness = sqrt(dot(mean, mean)) / HALF_DISC_OFFSET;
    Eigen e = decompose(squares.x - mean.x * mean.x, squares.y - mean.x * mean.y, squares.z - mean.y * mean.y);
    float ratio = e.first > 0.0 ? sqrt(e.second / e.first) : 1.0;
    offsets[position] = vec4(lift_tangent(mean), members);
    member_radii[position] = vec4(r2, radius.y, one_sidedness, ratio);
#if DESCRIPTOR == 1 || DESCRIPTOR == 2 // gradient, pca
#if DESCRIPTOR == 1
    float edge = ramp(one_sidedness, settings.free_at, settings.fixed_at);
#else
    float edge = ramp(one_sidedness, EDGE_FREE, EDGE_FIXED);
#endif
    float line = DESCRIPTOR == 2 ? ramp(ratio, settings.free_at, settings.fixed_at) : 0.0;
    vec2 across = edge > line || DESCRIPTOR == 1 ? mean : vec2(-e.axis.y, e.axis.x);
    write_constraint(position, members, mean, across, has_extent ? max(edge, line) : 0.0);
#endif
}

void main() {
    for (uint batch = 0u; batch < BATCH_COUNT(settings.gather); ++batch) {
        uint position;
        bool has_photon = take_turn(settings.gather, batch, position);
        take_query(position, settings.gather.period, settings.gather.flatness);
        set_tangents();
        vec4 radius = radii_at(position);
        offset_sum = vec2(0.0);
        square_sum = vec3(0.0);
        bool is_met = stream_members(settings.gather, has_photon && radius.x > 0.0, radius);
        if (has_photon && is_met) describe_photon(position, radius);
        report_turn(settings.gather, has_photon, is_met, position);
    }
}
