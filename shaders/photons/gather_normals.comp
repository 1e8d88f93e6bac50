// SPDX-License-Identifier: Apache-2.0
// Copies photon normals into tree order. In: normal_index (by photon id), tree_positions. Out: tree_normals.
#include "shared/prelude.glsl"
#pragma binding readonly vec4 normal_index
#pragma binding readonly vec4 tree_positions
#pragma binding writeonly vec4 tree_normals

layout(push_constant) uniform Push { uint first; uint count; };

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    uint position = first + gl_GlobalInvocationID.x;
    tree_normals[position] = vec4(normal_index[floatBitsToUint(tree_positions[position].w)].xyz, 0.0);
}
