// SPDX-License-Identifier: Apache-2.0
// How far photons' layers reach, (β·r_q)² of METHODS §4. Inputs: radii in parameter space and tree_positions (w photon
// id), in the order of the tree they were found in. Outputs: reaches_by_id.
#include "shared/prelude.glsl"
#include "shared/photons.h"
#pragma binding texel tree_positions
#pragma binding texel radii
#pragma binding writeonly float reaches_by_id

layout(push_constant) uniform Push { ReachSettings settings; };

void main() {
    if (gl_GlobalInvocationID.x >= settings.count) return;
    uint position = settings.first + gl_GlobalInvocationID.x;
    vec4 radius = radii_at(position);
    float radius2 = radius.w >= float(settings.k) ? radius.x : INFINITY; // else there are fewer than k others
    reaches_by_id[floatBitsToUint(tree_positions_at(position).w)] =
        settings.beta > 0.0 ? settings.beta * settings.beta * radius2 : 0.0;
}
