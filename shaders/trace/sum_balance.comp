// SPDX-License-Identifier: Apache-2.0
// Counts paths by outcome and sums their flux by fate, over blocks of 64 paths in index order.
// Inputs: summaries, deposited_flux, lost_flux, emitted_flux, emitters. Outputs: balance.
// Define HAS_COLORED_EMISSION: paths of a light do not all begin with the same flux.
#include "shared/prelude.glsl"
#include "shared/trace.h"
#pragma binding readonly PathSummary summaries
#pragma binding texel deposited_flux
#pragma binding texel lost_flux
#pragma binding texel emitted_flux
#pragma binding readonly LightEmission emitters
#pragma binding writeonly BalanceSum balance

layout(push_constant) uniform Push { TraceSettings settings; };

void main() {
    uint block = gl_GlobalInvocationID.x;
    uint first = block * PATHS_PER_BLOCK;
    if (first >= settings.count) return;
    BalanceSum sum = BalanceSum(uvec4(0u), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    for (uint path = first; path < min(first + PATHS_PER_BLOCK, settings.count); ++path) {
        uint outcome = summaries[path].outcome & 0xffu;
        sum.paths += uvec4(outcome == OUTCOME_ABSORBED, outcome == OUTCOME_ESCAPED, outcome == OUTCOME_TRUNCATED,
                           outcome == OUTCOME_RECEIVED);
        if (outcome == OUTCOME_UNFINISHED) sum.emitted.w += 1.0;
#ifdef HAS_COLORED_EMISSION
        sum.emitted.rgb += emitted_flux_at(path).rgb;
#else
        sum.emitted.rgb += emitters[summaries[path].outcome >> 8u].flux_cumulative.rgb;
#endif
        sum.deposited += deposited_flux_at(path);
        if (outcome == OUTCOME_ESCAPED) sum.escaped += lost_flux_at(path);
        if (outcome == OUTCOME_TRUNCATED) sum.truncated += lost_flux_at(path);
    }
    balance[block] = sum;
}
