// SPDX-License-Identifier: Apache-2.0
// Plots stored photons as points: each adds its flux, in units of the mean photon's, to the pixel that sees it.
// Inputs: scene, position_emitter, power_object. Defines: HAS_ALPHA, HAS_TEXTURES, HAS_VERTEX_COLORS, HAS_MEDIA. Output: plot (three fixed-point sums a pixel).
#include "shared/prelude.glsl"
#include "shared/render.h"
#include "shared/random.h"
#include "scene/coverage.glsl"
#ifdef HAS_MEDIA
#include "scene/scatter.glsl"
#endif
#pragma binding texel position_emitter
#pragma binding texel power_object
#pragma binding uint plot

layout(push_constant) uniform Push { PlotSettings settings; };

// A photon lies on a surface: the eye's ray is stopped short of it by this share of its length.
const float BEFORE_SURFACE = 0.9999;

bool is_visible(vec3 eye, vec3 to_photon) {
    float largest = max(abs(to_photon.x), max(abs(to_photon.y), abs(to_photon.z)));
    float distance = largest * sqrt(dot(to_photon / largest, to_photon / largest));
    float limit = distance * BEFORE_SURFACE;
#ifdef HAS_MEDIA
    return pass_media(Ray(eye, normalize_safely(to_photon)), limit, Media(0u, 0u), false).g > 0.5; // fog hides nothing here
#else
    return pass_scene(Ray(eye, normalize_safely(to_photon)), limit) > 0.5;
#endif
}

// Pixel column or row of a coordinate in (-1, 1) by the axis that reaches to the border; negative: outside.
int find_cell(float coordinate, uint size) {
    return abs(coordinate) < 1.0 ? min(int((coordinate + 1.0) * 0.5 * float(size)), int(size) - 1) : -1;
}

void main() {
    if (gl_GlobalInvocationID.x >= settings.count) return;
    uint photon = settings.first + gl_GlobalInvocationID.x;
    vec3 eye = settings.camera.position.xyz;
    vec3 to_photon = position_emitter_at(photon).xyz - eye;
    float depth = dot(to_photon, settings.camera.forward.xyz);
    vec3 right = settings.camera.right.xyz;
    vec3 up = settings.camera.up.xyz;
    int column = find_cell(dot(to_photon, right) / (dot(right, right) * depth), settings.width);
    int row = find_cell(-dot(to_photon, up) / (dot(up, up) * depth), settings.height);
    if (!(depth > 0.0) || column < 0 || row < 0 || !is_visible(eye, to_photon)) return;
    vec3 units = min(power_object_at(photon).rgb * settings.per_mean_flux * PLOT_UNIT + 0.5, vec3(1e6));
    uint at = 3u * (uint(row) * settings.width + uint(column));
    atomicAdd(plot[at], uint(units.r));
    atomicAdd(plot[at + 1u], uint(units.g));
    atomicAdd(plot[at + 2u], uint(units.b));
}
