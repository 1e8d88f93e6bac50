// SPDX-License-Identifier: Apache-2.0
// Repulsion of a photon from its members, and the move that follows: (1) and (3) to (5) of METHODS §3 [SJ09].
// Inputs: constraint_along and constraint_across (tree order: u_b and w_u, v_b and w_v); define CONSTRAINED to read them.
#include "shared/random.h"
#include "shared/relax.h"
#include "relax/tangent_plane.glsl"
#pragma binding texel constraint_along
#pragma binding texel constraint_across

layout(push_constant) uniform Push { RepelSettings settings; };

// Σ (x_i - x_k)/d_k and Σ (x_i - x_k) d_k: the force (1) is linear in both, so that r may follow later.
Place near_sum;
Place far_sum;
float coincident_sum; // photons at just this place, this one among them
float member_sum;
#ifdef FLAT_AXES
#define EACH_SUM(DO) DO(near_sum.x) DO(near_sum.y) DO(far_sum.x) DO(far_sum.y) DO(coincident_sum) DO(member_sum)
#else
#define EACH_SUM(DO) DO(near_sum.x) DO(near_sum.y) DO(near_sum.z) DO(far_sum.x) DO(far_sum.y) DO(far_sum.z) \
    DO(coincident_sum) DO(member_sum)
#endif

void clear_sums() {
    near_sum = Place(0.0);
    far_sum = Place(0.0);
    coincident_sum = 0.0;
    member_sum = 0.0;
}

void accumulate(Candidate other, float weight) {
    Place d = find_offset(other);
    float distance = sqrt(square_length(d));
    bool apart = distance > 0.0;
    near_sum -= d * (apart ? weight / distance : 0.0);
    far_sum -= d * (weight * distance);
    coincident_sum += apart ? 0.0 : weight;
#ifdef CARRIED
    member_sum += weight;
#endif
}

// What the sums came from.
struct Reach {
    float r2;      // squared radius
    float members; // K'
    float others;  // photons the radius was found from
};

vec3 constrain_move(vec3 f, uint position) {
#ifdef CONSTRAINED
    vec4 along = constraint_along_at(position);
    vec4 across = constraint_across_at(position);
    return along.xyz * ((1.0 - along.w) * dot(along.xyz, f)) + across.xyz * ((1.0 - across.w) * dot(across.xyz, f));
#else
    return f;
#endif
}

// Photons at one place are pushed apart by what floats can tell, each along its own tangent direction.
vec3 push_apart(uint position, Reach reach) {
    uint id = my_self;
    float s, c;
    sin_cos(2.0 * PI * to_unit_float(random_bits(0u, id, 0u, 0u)), s, c);
    set_tangents();
    return coincident_sum > 1.0 ? settings.spacing * lift_tangent(vec2(c, s)) : vec3(0.0);
}

vec4 find_move(uint position, Reach reach) {
    bool is_alone = reach.others == 0.0;
    float r = sqrt(reach.r2) * (reach.others == 1.0 ? 2.0 : 1.0);
    float span = r * settings.tau;
    vec3 f = vec3(0.0);
    if (r > 0.0) f = lift_place(near_sum * span - far_sum / span) / reach.members;
    f -= my_normal * dot(my_normal, f);
    float pressure = r > 0.0 ? sqrt(dot(f, f)) / r : 0.0;
    f = constrain_move(f, position);
    float share = r > 0.0 ? sqrt(dot(f, f)) / r : 0.0;
    f *= exp_exact(-share * share * settings.limiter);
    f += constrain_move(push_apart(position, reach), position);
    return is_alone ? vec4(0.0) : vec4(f, pressure);
}
