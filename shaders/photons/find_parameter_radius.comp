// SPDX-License-Identifier: Apache-2.0
// Distance of each photon to its k-th neighbour in parameter space, r_q of METHODS §4. Inputs: a tree over parameters
// (photons/parameter_candidates.glsl). Outputs: parameter_radii2 (by photon id: squared; INFINITY when there are fewer
// than k, or where the photon has no parameters), unanswered.
// gather.k is k - 1, and gather.flatness a bound on all squared distances.
#include "shared/prelude.glsl"
#include "photons/parameter_candidates.glsl"

#include "photons/find_radius.glsl"
#include "photons/each_photon.glsl"
#include "photons/count_coincident.glsl"
#pragma binding writeonly float parameter_radii2

layout(push_constant) uniform Push { GatherSettings settings; };

void main() {
    for (uint batch = 0u; batch < BATCH_COUNT(settings); ++batch) {
        uint position;
        bool has_photon = take_turn(settings, batch, position);
        take_photon(position, settings.period, settings.flatness);
        uint k = settings.k + 1u;
        float guess2 = guess_radius2(settings.photon_count, settings.leaf_level, position, settings.k);
        bool coincide = has_coincident(guess2 == 0.0, position, settings.photon_count, k);
        bool has_query = has_photon && !am_unset && !coincide;
        find_radius(has_query, settings.photon_count, settings.leaf_level, settings.k, guess2);
        bool has_all = has_query && my_gathered.others >= k;
        float r2 = coincide ? 0.0 : (has_all ? my_gathered.r2 : INFINITY);
        if (has_photon) {
            parameter_radii2[my_photon.photon] = am_unset ? INFINITY : r2;
        }
        report_turn(settings, has_photon, has_turns_left(), position);
    }
}
