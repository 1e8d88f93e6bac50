// SPDX-License-Identifier: Apache-2.0
// Keeps the device busy for minutes, by many invocations: llvmpipe ends any one's loops after 65,535 rounds together.
// Out: outputs.
#include "shared/prelude.glsl"
#pragma binding writeonly uvec4 outputs

layout(push_constant) uniform Push { uint count; };

void main() {
    uint state = gl_GlobalInvocationID.x;
    for (uint round = 0u; round < 65000u; ++round) state = (state ^ (state >> 7u)) * 1664525u + round;
    if (state % count == 1u) outputs[0] = uvec4(state);
}
