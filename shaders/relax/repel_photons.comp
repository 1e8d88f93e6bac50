// SPDX-License-Identifier: Apache-2.0
// How one step of relaxation moves each photon: repulsion from its K nearest (1), (2), kept in the tangent plane (3),
// along what its constraint allows (4), and limited (5) [SJ09]. Positions are only read (Jacobi).
// Inputs: the tree in its present places, constraint_along and constraint_across (tree order: u_b and w_u, v_b and w_v),
// radii. Outputs: moves (xyz metres, w pressure |f'|/r), with CARRIED radii (for the next step), unanswered.
// Defines: see photons/candidates.glsl and relax/repulsion.glsl.
#include "shared/prelude.glsl"
#include "photons/candidates.glsl"
#include "relax/repulsion.glsl"
#include "photons/stream_members.glsl"
#include "photons/take_turns.glsl"
#pragma binding coherent vec4 radii
#pragma binding writeonly vec4 moves

// Beyond this factor a carried radius' count is off by so much that the radius is sought anew in the next step.
const float LARGEST_MISS = 2.0;

// With CARRIED the radius of the step before serves again, corrected by the number of photons found within. Takes the
// members from the sums; returns the radius for the next step, 0 where it must be sought.
vec4 carry_radius(vec4 radius, inout Reach reach) {
    float wanted = float(settings.gather.rank - 2u);
    if (radius.w != CARRIED_RADIUS) return vec4(radius.xyz, CARRIED_RADIUS);
    float found = member_sum - 1.0; // less the photon itself
    reach.members = max(found, 1.0);
    reach.others = found > 0.0 ? wanted : 0.0;
    bool is_near = found * LARGEST_MISS >= wanted && found <= wanted * LARGEST_MISS;
    return vec4(is_near ? reach.r2 * (wanted + 0.5) / (found + 0.5) : 0.0, 0.0, 0.0, CARRIED_RADIUS);
}

void main() {
    for (uint batch = 0u; batch < BATCH_COUNT(settings.gather); ++batch) {
        uint position;
        bool has_photon = take_turn(settings.gather, batch, position);
        take_query(position, settings.gather.period, settings.gather.flatness);
        vec4 radius = radii[position];
        bool is_carried = radius.w == CARRIED_RADIUS;
        Reach reach = Reach(radius.x, radius.z, radius.w);
        clear_sums();
        if (is_carried) radius.y = 0.0;
        bool is_met = stream_members(settings.gather, has_photon && radius.x > 0.0, radius);
        if (radius.x == 0.0 && radius.w > 0.0) coincident_sum = 2.0; // all of them, at least
#ifdef CARRIED
        vec4 next = carry_radius(radius, reach);
        if (has_photon && is_met) radii[position] = next;
#endif
        vec4 move = find_move(position, reach);
        if (has_photon && is_met) moves[position] = move;
        report_turn(settings.gather, has_photon, is_met, position);
    }
}
