// SPDX-License-Identifier: Apache-2.0
// Arithmetic that a careless compiler folds away. In: numbers. Out: results (square, x - x, compensation of x + 1).
#include "shared/prelude.glsl"
#pragma binding readonly float numbers
#pragma binding writeonly vec4 results

layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    precise float x = numbers[i];
    precise float square = x * x;
    precise float nothing = x - x;
    precise float sum = x + 1.0;
    precise float lost = 1.0 - (sum - x); // exact in IEEE arithmetic: what rounding took from the 1
    results[i] = vec4(square, nothing, lost, float(gl_SubgroupSize));
}
