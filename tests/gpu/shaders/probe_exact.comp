// SPDX-License-Identifier: Apache-2.0
// Sums that a careless compiler folds away. In: inputs (x, y). Out: outputs: x - x, (x + y) - y, (y + x) - x, and the
// Kahan sum of TERMS times x, started at y.
#include "shared/prelude.glsl"
#pragma binding readonly vec4 inputs
#pragma binding writeonly vec4 outputs

layout(push_constant) uniform Push { uint count; };

float sum_compensated(float start, float term) {
    precise float sum = start;
    precise float lost = 0.0;
    for (uint i = 0u; i < TERMS; ++i) {
        precise float next = term - lost;
        precise float larger = sum + next;
        lost = (larger - sum) - next;
        sum = larger;
    }
    return sum;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    float x = inputs[i].x;
    float y = inputs[i].y;
    precise float nothing = x - x;
    precise float rounded_x = (x + y) - y;
    precise float rounded_y = (y + x) - x;
    outputs[i] = vec4(nothing, rounded_x, rounded_y, sum_compensated(y, x));
}
