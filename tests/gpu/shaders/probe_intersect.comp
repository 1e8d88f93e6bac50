// SPDX-License-Identifier: Apache-2.0
// Rays against a scene. In: geometry, inputs (origin, direction with the farthest distance in w).
// Out: outputs (distance, barycentric weights of vertices 1 and 2, triangle as bits). Define ANY_HIT.
#include "shared/prelude.glsl"
#include "scene/intersect.glsl"

struct ProbeRay {
    vec4 origin;
    vec4 direction;
};

#pragma binding readonly ProbeRay inputs
#pragma binding writeonly vec4 outputs

layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    Hit hit = intersect_scene(Ray(inputs[i].origin.xyz, inputs[i].direction.xyz), inputs[i].direction.w, ANY_HIT);
    outputs[i] = vec4(hit.t, hit.b1, hit.b2, uintBitsToFloat(hit.triangle));
}
