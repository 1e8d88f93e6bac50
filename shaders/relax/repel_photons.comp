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

void main() {
    for (uint batch = 0u; batch < BATCH_COUNT(settings.gather); ++batch) {
        uint position;
        bool has_photon = take_turn(settings.gather, batch, position);
        take_photon(position, settings.gather.period, settings.gather.flatness);
        float guess2 = radii[position] * settings.gather.carry;
        if (guess2 <= 0.0)
            guess2 = guess_radius2(settings.gather.photon_count, settings.gather.leaf_level, position, settings.gather.k);
        gather_members(has_photon, settings.gather.photon_count, settings.gather.leaf_level, settings.gather.k, guess2);
        vec4 move = find_move(position, Reach(my_gathered.r2, my_gathered.members, my_gathered.others));
        if (has_photon) {
            moves[position] = move;
            radii[position] = my_gathered.r2;
        }
        report_turn(has_photon, has_turns_left(), position);
    }
}
