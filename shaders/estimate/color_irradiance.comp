// SPDX-License-Identifier: Apache-2.0
// False color: the mean color of the photons around a point, weighed as the density kernel weighs them, times the
// luminance of their irradiance. Inputs: color_sums (the estimate from colors; w: from ones). In and out: irradiance.
#include "shared/prelude.glsl"
#include "shared/render.h"
#include "estimate/luminance.glsl"
#pragma binding texel color_sums
#pragma binding vec4 irradiance

layout(push_constant) uniform Push { FilmSettings settings; };

void main() {
    uint at = gl_GlobalInvocationID.x;
    if (at >= settings.sample_count * settings.slot_count) return;
    vec4 sums = color_sums_at(at);
    vec3 mean = sums.w > 0.0 ? sums.rgb / sums.w : vec3(0.0);
    irradiance[at] = vec4(mean * find_luminance(irradiance[at].rgb), 0.0);
}
