// SPDX-License-Identifier: Apache-2.0
// The radius of each query's neighborhood: the measure of the candidate of gather.rank. Inputs: the tree and the queries
// (photons/candidates.glsl). In and out: radii (photons/search_radius.glsl; in: squared radii of gather.carry of what is
// sought, 0: none; with CARRIED those that were carried over stay). Outputs: unanswered.
#include "shared/prelude.glsl"
#include "photons/search_radius.glsl"
#include "photons/guess_radius.glsl"
#include "photons/take_turns.glsl"
#pragma binding coherent vec4 radii

layout(push_constant) uniform Push { GatherSettings settings; };

// Loop turns a batch may take, and more for each of the rank: some ten times what is usual. Where it takes more, bounds
// keep little of the map away, and one query at a time is cheaper.
const uint USUAL_TURNS = 4000u;
const uint USUAL_TURNS_EACH = 16u;

#ifdef CARRIED
bool is_carried(vec4 radius) { return radius.w == CARRIED_RADIUS && radius.x > 0.0; }
#else
bool is_carried(vec4 radius) { return false; }
#endif

void main() {
    float beyond2 = 0.0; // of the batch before: from the nearest photon's measure to the radius …
    uint nearest_at = 0u; // … and where that photon stands
    for (uint batch = 0u; batch < settings.batches; ++batch) {
        uint query;
        bool has_query = take_turn(settings, batch, query);
        turn_limit = min(turn_limit, turns + USUAL_TURNS + USUAL_TURNS_EACH * settings.rank);
        take_query(query * settings.stride, settings.period, settings.flatness);
        vec4 radius = radii[query];
        bool seeks = has_query && can_find() && !is_carried(radius);
        float guess2 = settings.carry > 0.0 ? radius.x * settings.carry : 0.0;
        float nearest2 = 0.0;
        if (beyond2 > 0.0) { // the same photon is near this query too
            nearest2 = measure_candidate(load_candidate(min(nearest_at, settings.photon_count - 1u), true));
            guess2 = nearest2 < INFINITY ? nearest2 + beyond2 : 0.0;
        }
        bool needs_guess = seeks && guess2 <= 0.0;
        if (any_lane(needs_guess)) {
            float guessed_nearest2;
            float guessed2 = guess_radius2(settings, query, guessed_nearest2);
            guess2 = needs_guess ? guessed2 : guess2;
            nearest2 = needs_guess ? guessed_nearest2 : nearest2;
        }
        find_radius(seeks, settings, guess2, nearest2);
        if (has_query && !is_carried(radius)) radii[query] = my_radius;
        report_turn(settings, has_query, is_settled || !seeks, query);
#ifndef OWN_PHOTONS
        beyond2 = is_settled ? my_radius.x - my_search.nearest : 0.0;
        nearest_at = my_search.nearest_at;
#endif
    }
}
