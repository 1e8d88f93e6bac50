// SPDX-License-Identifier: Apache-2.0
// Of queries at whose radius more photons lie than photons/select_radius.comp holds: how many photons lie nearer and how many at just the radius,
// and so the weight of the latter. Inputs: the tree, the queries, singles. In and out: radii (x and w known).
// Outputs: unanswered.
#include "shared/prelude.glsl"
#include "photons/radii.glsl"
#include "photons/candidates.glsl"

float nearer_sum;
float equal_sum;
float counted_r2;
#define EACH_SUM(DO) DO(nearer_sum) DO(equal_sum)

void accumulate(Candidate other, float weight) {
    float measure = measure_candidate(other);
    nearer_sum += measure < counted_r2 ? 1.0 : 0.0;
    equal_sum += measure == counted_r2 ? 1.0 : 0.0;
}

#include "photons/stream_members.glsl"
#include "photons/take_turns.glsl"
#pragma binding coherent vec4 radii

layout(push_constant) uniform Push { GatherSettings settings; };

void main() {
    uint query;
    bool has_query = take_turn(settings, 0u, query);
    take_query(query * settings.stride, settings.period, settings.flatness);
    vec4 radius = radii[query];
    counted_r2 = radius.x;
    nearer_sum = 0.0;
    equal_sum = 0.0;
    bool is_counted = stream_members(settings, has_query, radius);
    if (has_query && is_counted)
        radii[query] = radius.w > 0.0 ? share_ties(radius.x, uint(radius.w) + 1u, uint(nearer_sum), uint(equal_sum))
                                      : vec4(0.0);
    report_turn(settings, has_query, is_counted, query);
}
