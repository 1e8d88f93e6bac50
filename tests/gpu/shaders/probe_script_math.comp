// SPDX-License-Identifier: Apache-2.0
// Evaluates one function of shaders/script/ of the numbers in `inputs`. Out: outputs (w: 1 where it was reported).
// Define CALL, with the input v and its bits b.
#include "shared/prelude.glsl"
#include "shared/math.glsl"
#pragma binding readonly vec4 inputs
#pragma binding writeonly vec4 outputs

layout(push_constant) uniform Push { uint count; };

// In place of script/pass.glsl.
#define NAN uintBitsToFloat(0x7fc00000u)
struct Settings { uint seed; };
const Settings settings = Settings(7u);
uint turns = 0u;
bool is_reported = false;
void fault_if(bool is_bad, uint site) { is_reported = is_reported || is_bad; }

#include "script/numbers.glsl"
#include "script/functions.glsl"

float to_output(float x) { return x; }
float to_output(int x) { return intBitsToFloat(x); }

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    vec4 v = inputs[i];
    ivec4 b = floatBitsToInt(v);
    float result = to_output(CALL);
    outputs[i] = vec4(result, 0.0, 0.0, is_reported ? 1.0 : 0.0);
}
