// SPDX-License-Identifier: Apache-2.0
// Copies photon positions with their ids, ready to be put in tree order, and bounds them; a subgroup takes TREE_PART.
// In: position_emitter. Out: tree_positions, box_keys (of node 0).
#include "shared/prelude.glsl"
#include "photons/tree_layout.glsl"
#include "photons/box_keys.glsl"
#pragma binding texel position_emitter
#pragma binding writeonly vec4 tree_positions

layout(push_constant) uniform Push { uint first; uint count; };

void main() {
    uint end = min(first + count, first + (gl_WorkGroupID.x + 1u) * TREE_PART);
    vec3 lo = vec3(INFINITY), hi = vec3(-INFINITY);
    for (uint i = first + gl_WorkGroupID.x * TREE_PART + gl_LocalInvocationID.x; i < end; i += gl_WorkGroupSize.x) {
        vec3 p = position_emitter_at(i).xyz;
        lo = vec3(p.x < lo.x ? p.x : lo.x, p.y < lo.y ? p.y : lo.y, p.z < lo.z ? p.z : lo.z);
        hi = vec3(p.x > hi.x ? p.x : hi.x, p.y > hi.y ? p.y : hi.y, p.z > hi.z ? p.z : hi.z);
        tree_positions[i] = vec4(p, uintBitsToFloat(i));
    }
    widen_box(0u, lo, hi);
}
