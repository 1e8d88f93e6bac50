// SPDX-License-Identifier: Apache-2.0
// Adds each visible photon as a soft point to the pixels around it.
// Inputs: position_emitter, colors (RGBA8 by photon), marks, surface_points and surface_normals (SurfaceView).
// Output: sums (SPLAT_SUMS fixed-point numbers a pixel).
#include "shared/prelude.glsl"
#include "shared/splat.h"
#pragma binding texel position_emitter
#pragma binding readonly uint colors
#pragma binding readonly uint marks
#pragma binding texel surface_points
#pragma binding texel surface_normals
#pragma binding uint sums

layout(push_constant) uniform Push { SplatSettings settings; };

// A photon lies on a surface: it may stand this share of the depth behind the plane seen there, for planes are not
// what curved meshes are between pixels.
const float BEHIND = 4e-3;

bool is_hidden(vec3 place, uint pixel) {
    if (settings.has_surface == 0u) return false;
    vec4 seen = surface_points_at(pixel);
    if (!(seen.w < INFINITY)) return false;
    return dot(place - seen.xyz, surface_normals_at(pixel).xyz) < -BEHIND * seen.w;
}

void add_point(uint photon, uint pixel, float weight) {
    uint units = uint(weight * settings.unit + 0.5);
    if (units == 0u) return;
    bool is_marked = settings.has_marks == 0u || marks[photon] != 0u;
    uint at = SPLAT_SUMS * pixel + (is_marked ? 0u : 4u);
    atomicAdd(sums[at], units);
    if (settings.has_colors == 0u) return;
    uvec3 color = (uvec3(colors[photon]) >> uvec3(0u, 8u, 16u) & 255u) >> 2u;
    atomicAdd(sums[at + 1u], units * color.r);
    atomicAdd(sums[at + 2u], units * color.g);
    atomicAdd(sums[at + 3u], units * color.b);
}

void main() {
    if (gl_GlobalInvocationID.x >= settings.count) return;
    uint photon = settings.first + gl_GlobalInvocationID.x;
    vec3 place = position_emitter_at(photon).xyz + settings.shift_radius.xyz;
    vec3 to_photon = place - settings.camera.position.xyz;
    float depth = dot(to_photon, settings.camera.forward.xyz);
    vec3 right = settings.camera.right.xyz, up = settings.camera.up.xyz;
    vec2 size = vec2(settings.width, settings.height);
    vec2 at = vec2(dot(to_photon, right) / (dot(right, right) * depth), -dot(to_photon, up) / (dot(up, up) * depth));
    at = (at + 1.0) * 0.5 * size;
    float reach = settings.shift_radius.w + 0.5;
    if (!(depth > 0.0) || any(lessThan(at, vec2(-reach))) || any(greaterThan(at, size + reach))) return;
    ivec2 low = max(ivec2(floor(at - reach)), ivec2(0));
    ivec2 high = min(ivec2(floor(at + reach)), ivec2(size) - 1);
    ivec2 inside = clamp(ivec2(floor(at)), ivec2(0), ivec2(size) - 1);
    if (is_hidden(place, uint(inside.y) * settings.width + uint(inside.x))) return;
    for (int row = low.y; row <= high.y; ++row)
        for (int column = low.x; column <= high.x; ++column) {
            float distance = length(vec2(column, row) + 0.5 - at);
            float weight = clamp(reach - distance, 0.0, 1.0);
            if (weight > 0.0) add_point(photon, uint(row) * settings.width + uint(column), weight);
        }
}
