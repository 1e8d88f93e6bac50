// SPDX-License-Identifier: Apache-2.0
// The first surface that each pixel's center sees. Input: scene. Outputs: surface_points (xyz, w depth along the view's
// axis, INFINITY: nothing), surface_normals (xyz shading normal towards the eye, w object).
#include "shared/prelude.glsl"
#include "shared/inspect.h"
#include "scene/scatter.glsl"
#pragma binding writeonly vec4 surface_points
#pragma binding writeonly vec4 surface_normals

layout(push_constant) uniform Push { SurfaceSettings settings; };

void main() {
    if (gl_GlobalInvocationID.x >= settings.count) return;
    uint pixel = settings.first + gl_GlobalInvocationID.x;
    float x = 2.0 * (float(pixel % settings.width) + 0.5) / float(settings.width) - 1.0;
    float y = 1.0 - 2.0 * (float(pixel / settings.width) + 0.5) / float(settings.height);
    vec3 forward = settings.camera.forward.xyz;
    vec3 direction = normalize_safely(forward + x * settings.camera.right.xyz + y * settings.camera.up.xyz);
    Hit hit = intersect_scene(Ray(settings.camera.position.xyz, direction), INFINITY, false);
    surface_points[pixel] = vec4(0.0, 0.0, 0.0, INFINITY);
    surface_normals[pixel] = vec4(0.0, 0.0, 0.0, uintBitsToFloat(NO_CELL));
    if (!(hit.t < INFINITY)) return;
    Surface surface = load_surface(hit);
    surface_points[pixel] = vec4(surface.position, hit.t * dot(direction, forward));
    surface_normals[pixel] = vec4(face_arrival(surface, direction), uintBitsToFloat(surface.object));
}
