// SPDX-License-Identifier: Apache-2.0
// Boxes that several subgroups widen: six integers a node, the least of the coordinates' keys and of those keys'
// complements, all bits set at first.
#include "photons/float_keys.glsl"
#pragma binding coherent uint box_keys

uint order_key(float value) { return uint(make_key(value)) ^ 0x80000000u; }
float read_ordered(uint key) { return read_key(int(key ^ 0x80000000u)); }

void widen_box(uint node, vec3 lo, vec3 hi) {
    for (uint i = 0u; i < 3u; ++i) {
        uint least = find_least(order_key(lo[i]));
        uint greatest = find_least(~order_key(hi[i]));
        if (gl_SubgroupInvocationID == 0u) {
            atomicMin(box_keys[6u * node + i], least);
            atomicMin(box_keys[6u * node + 3u + i], greatest);
        }
    }
}

vec3 read_box_lo(uint node) {
    return vec3(read_ordered(box_keys[6u * node]), read_ordered(box_keys[6u * node + 1u]),
                read_ordered(box_keys[6u * node + 2u]));
}

vec3 read_box_hi(uint node) {
    return vec3(read_ordered(~box_keys[6u * node + 3u]), read_ordered(~box_keys[6u * node + 4u]),
                read_ordered(~box_keys[6u * node + 5u]));
}
