// SPDX-License-Identifier: Apache-2.0
// How one step of relaxation moves each photon: repulsion from its K nearest (1), (2), kept in the tangent plane (3),
// along what its constraint allows (4), and limited (5) [SJ09]. Positions are only read (Jacobi).
// Inputs: the tree in its present places, tree_normals, constraint_along and constraint_across (tree order: u_b and w_u,
// v_b and w_v), radii (squared, of the step before). Outputs: moves (xyz metres, w pressure |f'|/r), radii,
// unanswered (1: a workgroup's turns did not suffice).
// Defines: see photons/gather.glsl, photons/world_candidates.glsl and relax/repulsion.glsl.
#include "shared/prelude.glsl"
#include "relax/repulsion.glsl"
#include "photons/gather.glsl"
#include "photons/each_photon.glsl"
#pragma binding coherent float radii
#pragma binding writeonly vec4 moves

// With CARRIED the radius of the step before serves again, corrected by the number of photons found within.
#ifdef CARRIED
const bool IS_CARRIED = true;
#else
const bool IS_CARRIED = false;
#endif
// Beyond this factor the count is off by so much that the radius is sought anew in the next step.
const float LARGEST_MISS = 2.0;

// Takes the members from the sums; returns the squared radius for the next step, 0 where it must be sought.
float carry_radius(inout Reach reach) {
    float found = member_sum - 1.0; // less the photon itself
    float wanted = float(settings.gather.k);
    reach.members = max(found, 1.0);
    reach.others = found > 0.0 ? settings.gather.k : 0u;
    bool is_near = found * LARGEST_MISS >= wanted && found <= wanted * LARGEST_MISS;
    return is_near ? reach.r2 * (wanted + 0.5) / (found + 0.5) : 0.0;
}

void main() {
    for (uint batch = 0u; batch < BATCH_COUNT(settings.gather); ++batch) {
        uint position;
        bool has_photon = take_turn(settings.gather, batch, position);
        take_photon(position, settings.gather.period, settings.gather.flatness);
        float guess2 = radii[position] * settings.gather.carry;
        bool is_known = IS_CARRIED && guess2 > 0.0;
        if (guess2 <= 0.0)
            guess2 = guess_radius2(settings.gather.photon_count, settings.gather.leaf_level, position, settings.gather.k);
        find_radius(has_photon && !is_known, settings.gather.photon_count, settings.gather.leaf_level,
                    settings.gather.k, guess2);
        Reach reach = is_known ? Reach(guess2, 0.0, settings.gather.k)
                               : Reach(my_gathered.r2, my_gathered.members, my_gathered.others);
        clear_sums();
        stream_members(has_photon, settings.gather.photon_count, settings.gather.leaf_level, reach.r2,
                       is_known ? 0.0 : my_gathered.tie_weight);
        float next2 = reach.r2;
        if (is_known) next2 = carry_radius(reach);
        vec4 move = find_move(position, reach);
        if (has_photon) {
            moves[position] = move;
            radii[position] = next2;
        }
        report_turn(settings.gather, has_photon, has_turns_left(), position);
    }
}
