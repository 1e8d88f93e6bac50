// SPDX-License-Identifier: Apache-2.0
// What shaders/shared/subgroup.glsl says of each subgroup. In: inputs (x a number, y 1: the lane is in). Out: two rows
// each: least, greatest, sum, sum before; lanes that are in, those before, the first, any + 2 all + 4 (lane 1's x is ours).
#include "shared/prelude.glsl"
#pragma binding readonly vec4 inputs
#pragma binding writeonly vec4 outputs

layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x; // whole workgroups alone: every lane is active
    float x = inputs[i].x;
    bool is_in = inputs[i].y > 0.0;
    uvec2 lanes = find_lanes(is_in);
    uint flags = uint(any_lane(is_in)) + 2u * uint(all_lanes(is_in)) + 4u * uint(broadcast(x, 1u) == x);
    outputs[2u * i] = vec4(find_least(x), find_most(x), sum_lanes(x), sum_before(uint(x)));
    outputs[2u * i + 1u] = vec4(count_lanes(lanes), count_before(lanes), find_first_lane(lanes), flags);
}
