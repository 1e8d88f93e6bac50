// SPDX-License-Identifier: Apache-2.0
// How one step of relaxation moves each photon: repulsion from its K nearest (1), (2), kept in the tangent plane (3),
// along what its constraint allows (4), and limited (5) [SJ09]. Positions are only read (Jacobi).
// Inputs: the tree in its present places, tree_normals, constraint_along and constraint_across (tree order: u_b and w_u,
// v_b and w_v), radii (squared, of the step before). Outputs: moves (xyz metres, w pressure |f'|/r), radii,
// unanswered (1: a workgroup's turns did not suffice).
// Defines: see photons/gather.glsl and photons/world_candidates.glsl; CONSTRAINED.
#include "shared/prelude.glsl"
#include "shared/random.h"
#include "shared/relax.h"
#include "relax/tangent_plane.glsl"

// Σ (x_i - x_k)/d_k and Σ (x_i - x_k) d_k: the force (1) is linear in both, so that r may follow later.
Place near_sum;
Place far_sum;
float coincident_sum; // photons at just this place, this one among them

void clear_sums() {
    near_sum = Place(0.0);
    far_sum = Place(0.0);
    coincident_sum = 0.0;
}

void accumulate(Candidate other, float weight) {
    Place d = find_offset(other);
    float distance = sqrt(square_length(d));
    bool apart = distance > 0.0;
    near_sum -= d * (apart ? weight / distance : 0.0);
    far_sum -= d * (weight * distance);
    coincident_sum += apart ? 0.0 : weight;
}

#include "photons/gather.glsl"
#pragma binding readonly vec4 constraint_along
#pragma binding readonly vec4 constraint_across
#pragma binding coherent float radii
#pragma binding writeonly vec4 moves
#pragma binding writeonly uint unanswered

layout(push_constant) uniform Push { RepelSettings settings; };

vec3 constrain_move(vec3 f, uint position) {
#ifdef CONSTRAINED
    vec4 along = constraint_along[position];
    vec4 across = constraint_across[position];
    return along.xyz * ((1.0 - along.w) * dot(along.xyz, f)) + across.xyz * ((1.0 - across.w) * dot(across.xyz, f));
#else
    return f;
#endif
}

// Photons at one place are pushed apart by what floats can tell, each along its own tangent direction.
vec3 push_apart(uint position) {
    uint id = floatBitsToUint(tree_positions_at(position).w);
    float s, c;
    sin_cos(2.0 * PI * to_unit_float(random_bits(0u, id, 0u, 0u)), s, c);
    set_tangents();
    return coincident_sum > 1.0 || (coincident_sum > 0.0 && my_gathered.r2 == 0.0)
        ? settings.spacing * lift_tangent(vec2(c, s)) : vec3(0.0);
}

vec4 find_move(uint position) {
    bool is_alone = my_gathered.others == 0u;
    float r = sqrt(my_gathered.r2) * (my_gathered.others == 1u ? 2.0 : 1.0);
    float reach = r * settings.tau;
    vec3 f = vec3(0.0);
    if (r > 0.0) f = lift_place(near_sum * reach - far_sum / reach) / my_gathered.members;
    f -= my_normal * dot(my_normal, f);
    float pressure = r > 0.0 ? sqrt(dot(f, f)) / r : 0.0;
    f = constrain_move(f, position);
    float share = r > 0.0 ? sqrt(dot(f, f)) / r : 0.0;
    f *= exp_exact(-share * share * settings.limiter);
    f += constrain_move(push_apart(position), position);
    return is_alone ? vec4(0.0) : vec4(f, pressure);
}

void main() {
    uint first = gl_WorkGroupID.x * WIDTH * settings.gather.batches;
    for (uint batch = 0u; batch < settings.gather.batches; ++batch) {
        uint turn = first + batch * WIDTH + LANE;
        bool has_photon = turn < settings.gather.count;
        uint position = settings.gather.first + min(turn, settings.gather.count - 1u);
        take_photon(position, settings.gather.period, settings.gather.flatness);
        float guess2 = radii[position] * settings.gather.carry;
        if (guess2 <= 0.0)
            guess2 = guess_radius2(settings.gather.photon_count, settings.gather.leaf_level, position, settings.gather.k);
        gather_members(has_photon, settings.gather.photon_count, settings.gather.leaf_level, settings.gather.k, guess2);
        vec4 move = find_move(position);
        if (has_photon) {
            moves[position] = move;
            radii[position] = my_gathered.r2;
            if (!has_turns_left()) unanswered[0] = 1u;
        }
    }
}
