// SPDX-License-Identifier: Apache-2.0
// Copies how far photons' layers reach into tree order. Inputs: tree_positions (w photon id), reaches_by_id.
// Outputs: tree_reaches.
#include "shared/prelude.glsl"
#include "shared/photons.h"
#pragma binding texel tree_positions
#pragma binding readonly float reaches_by_id
#pragma binding writeonly float tree_reaches

layout(push_constant) uniform Push { ReachSettings settings; };

void main() {
    if (gl_GlobalInvocationID.x >= settings.count) return;
    uint position = settings.first + gl_GlobalInvocationID.x;
    tree_reaches[position] = reaches_by_id[floatBitsToUint(tree_positions_at(position).w)];
}
