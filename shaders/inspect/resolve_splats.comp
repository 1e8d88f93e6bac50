// SPDX-License-Identifier: Apache-2.0
// Turns the sums of points into pixels over the shaded surfaces: chosen photons over the grey ones of the context.
// Inputs: sums, surface_points, surface_normals. Output: pixels (RGBA8, sRGB).
#include "shared/prelude.glsl"
#include "shared/splat.h"
#pragma binding readonly uint sums
#pragma binding texel surface_points
#pragma binding texel surface_normals
#pragma binding writeonly uint pixels

layout(push_constant) uniform Push { ResolveSettings settings; };

const vec3 SURFACE_LOW = vec3(0.135, 0.14, 0.15);
const vec3 SURFACE_HIGH = vec3(0.30, 0.31, 0.33);
const vec3 CONTEXT = vec3(0.48);

vec3 shade_surface(uint pixel) {
    if (settings.has_surface == 0u) return settings.background.rgb;
    vec4 seen = surface_points_at(pixel);
    if (!(seen.w < INFINITY)) return settings.background.rgb;
    vec3 to_eye = normalize(settings.eye.xyz - seen.xyz);
    return mix(SURFACE_LOW, SURFACE_HIGH, clamp(dot(to_eye, surface_normals_at(pixel).xyz), 0.0, 1.0));
}

float find_opacity(uint weight) {
    return 1.0 - exp(-settings.strength * float(weight) / settings.unit);
}

vec3 find_mean_color(uint at, uint weight) {
    if (settings.has_colors == 0u) return settings.plain.rgb;
    return vec3(sums[at + 1u], sums[at + 2u], sums[at + 3u]) / (SPLAT_CHANNEL * float(weight));
}

void main() {
    if (gl_GlobalInvocationID.x >= settings.count) return;
    uint pixel = settings.first + gl_GlobalInvocationID.x;
    uint at = SPLAT_SUMS * pixel;
    vec3 color = shade_surface(pixel);
    uint context = sums[at + 4u];
    if (settings.has_marks != 0u && context > 0u) color = mix(color, CONTEXT, 0.6 * find_opacity(context));
    uint marked = sums[at];
    if (marked > 0u) color = mix(color, find_mean_color(at, marked), find_opacity(marked));
    uvec3 bytes = uvec3(clamp(color, 0.0, 1.0) * 255.0 + 0.5);
    pixels[pixel] = bytes.r | bytes.g << 8u | bytes.b << 16u | 0xff000000u;
}
