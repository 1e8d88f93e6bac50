// SPDX-License-Identifier: Apache-2.0
// What a step did, summed over runs of photons in a fixed order. Inputs: moves, radii (squared).
// Outputs: move_sums (x Σ |move|/r, y largest |move|/r, z Σ pressure, w Σ |move|), one a run.
#include "shared/prelude.glsl"
#include "shared/relax.h"
#pragma binding texel moves
#pragma binding texel radii
#pragma binding writeonly vec4 move_sums

layout(push_constant) uniform Push { MoveSettings settings; };

void main() {
    uint run = gl_GlobalInvocationID.x;
    if (run >= settings.count) return;
    vec4 sums = vec4(0.0);
    for (uint i = run * SUM_RUN; i < min((run + 1u) * SUM_RUN, settings.photon_count); ++i) {
        vec4 move = moves_at(i);
        float size = sqrt(dot(move.xyz, move.xyz));
        float r2 = radii_at(i).x;
        float share = r2 > 0.0 ? size / sqrt(r2) : 0.0;
        sums = vec4(sums.x + share, max(sums.y, share), sums.z + move.w, sums.w + size);
    }
    move_sums[run] = sums;
}
