// SPDX-License-Identifier: Apache-2.0
// Copies photon normals and emitters into tree order. In: normal_index, position_emitter (by photon id),
// tree_positions. Out: tree_normals (w emitter as bits).
#include "shared/prelude.glsl"
#pragma binding readonly vec4 normal_index
#pragma binding readonly vec4 position_emitter
#pragma binding readonly vec4 tree_positions
#pragma binding writeonly vec4 tree_normals

layout(push_constant) uniform Push { uint first; uint count; };

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    uint position = first + gl_GlobalInvocationID.x;
    uint photon = floatBitsToUint(tree_positions[position].w);
    tree_normals[position] = vec4(normal_index[photon].xyz, position_emitter[photon].w);
}
