// SPDX-License-Identifier: Apache-2.0
// Evaluates one function of shared/math.glsl. In: inputs. Out: outputs. Define FUNCTION.
#include "shared/prelude.glsl"
#include "shared/math.glsl"
#pragma binding readonly vec4 inputs
#pragma binding writeonly vec4 outputs

layout(push_constant) uniform Push { uint count; };

vec4 evaluate(vec4 v) {
    vec4 result = vec4(0.0);
#if FUNCTION == 0
    sin_cos(v.x, result.x, result.y);
#elif FUNCTION == 1
    result.x = asin_core(v.x);
#elif FUNCTION == 2
    result.x = acos_exact(v.x);
#elif FUNCTION == 3
    result.x = exp_exact(v.x);
#elif FUNCTION == 5
    sin_cos_turn(floatBitsToUint(v.x), result.x, result.y);
#else
    result.xyz = normalize_safely(v.xyz);
#endif
    return result;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < count) outputs[i] = evaluate(inputs[i]);
}
