// SPDX-License-Identifier: Apache-2.0
// Random numbers as the kernels draw them. In: inputs (seed, index, bounce, dimension). Out: outputs: the hash's word,
// its unit float as bits, the Sobol fraction and the scrambled one (of dimension mod 3).
#include "shared/prelude.glsl"
#include "shared/random.h"
#pragma binding readonly uvec4 inputs
#pragma binding writeonly uvec4 outputs

layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uvec4 key = inputs[i];
    uint word = random_bits(key.x, key.y, key.z, key.w);
    outputs[i] = uvec4(word, floatBitsToUint(to_unit_float(word)), sobol_bits(key.y, key.w % 3u),
                       sample_sobol(key.x, key.y, key.w % 3u));
}
