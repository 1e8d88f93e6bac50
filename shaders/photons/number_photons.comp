// SPDX-License-Identifier: Apache-2.0
// Copies photon positions with their ids, ready to be put in tree order. In: position_emitter. Out: tree_positions.
#include "shared/prelude.glsl"
#pragma binding readonly vec4 position_emitter
#pragma binding writeonly vec4 tree_positions

layout(push_constant) uniform Push { uint first; uint count; };

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    uint photon = first + gl_GlobalInvocationID.x;
    tree_positions[photon] = vec4(position_emitter[photon].xyz, uintBitsToFloat(photon));
}
