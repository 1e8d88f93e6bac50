// SPDX-License-Identifier: Apache-2.0
// Divides every photon's flux by the number emitted, once that number is known. In and out: power_object.
#include "shared/prelude.glsl"
#pragma binding vec4 power_object

layout(push_constant) uniform Push { uint first; uint count; float factor; };

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    uint photon = first + gl_GlobalInvocationID.x;
    power_object[photon].rgb *= factor;
}
