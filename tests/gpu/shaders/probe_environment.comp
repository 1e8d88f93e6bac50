// SPDX-License-Identifier: Apache-2.0
// Directions drawn from an environment. In: environment_map, inputs (two 32-bit fractions). Out, two for each: direction
// with the largest channel of its texel in w, and what is seen along it with the density per steradian in w.
#include "shared/prelude.glsl"
#include "shared/math.glsl"
#include "scene/environment.glsl"
#pragma binding readonly uvec2 inputs
#pragma binding writeonly vec4 outputs

layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    EnvironmentHeader sky = load_environment();
    EnvironmentPoint drawn = sample_environment(sky, inputs[i]);
    EnvironmentPoint seen = see_environment(sky, drawn.direction);
    outputs[2u * i] = vec4(drawn.direction, drawn.largest);
    outputs[2u * i + 1u] = vec4(seen.radiance, drawn.largest / sky.whole);
}
