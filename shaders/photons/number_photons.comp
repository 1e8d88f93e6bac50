// SPDX-License-Identifier: Apache-2.0
// Copies photon positions with their ids, ready to be put in tree order, and bounds them and their emitters; a subgroup
// takes TREE_PART. In: position_emitter. Out: tree_positions, box_keys (of node 0), emitters (least, complement of
// greatest; all bits set at first).
#include "shared/prelude.glsl"
#include "photons/tree_layout.glsl"
#include "photons/box_keys.glsl"
#pragma binding texel position_emitter
#pragma binding writeonly vec4 tree_positions
#pragma binding coherent uint emitters

layout(push_constant) uniform Push { uint first; uint count; };

void main() {
    uint end = min(first + count, first + (gl_WorkGroupID.x + 1u) * TREE_PART);
    vec3 lo = vec3(INFINITY), hi = vec3(-INFINITY);
    uint least = 0xffffffffu, greatest = 0xffffffffu;
    for (uint i = first + gl_WorkGroupID.x * TREE_PART + gl_LocalInvocationID.x; i < end; i += gl_WorkGroupSize.x) {
        vec4 photon = position_emitter_at(i);
        vec3 p = photon.xyz;
        least = min(least, floatBitsToUint(photon.w));
        greatest = min(greatest, ~floatBitsToUint(photon.w));
        lo = vec3(p.x < lo.x ? p.x : lo.x, p.y < lo.y ? p.y : lo.y, p.z < lo.z ? p.z : lo.z);
        hi = vec3(p.x > hi.x ? p.x : hi.x, p.y > hi.y ? p.y : hi.y, p.z > hi.z ? p.z : hi.z);
        tree_positions[i] = vec4(p, uintBitsToFloat(i));
    }
    widen_box(0u, lo, hi);
    least = find_least(least);
    greatest = find_least(greatest);
    if (gl_SubgroupInvocationID == 0u) {
        atomicMin(emitters[0], least);
        atomicMin(emitters[1], greatest);
    }
}
