// SPDX-License-Identifier: Apache-2.0
// The first surface that each pixel's center sees, or the first behind glass. Input: scene. Outputs: surface_points (xyz, w depth along the view's
// axis, INFINITY: nothing), surface_normals (xyz shading normal towards the eye, w object).
#include "shared/prelude.glsl"
#include "shared/random.h"
#include "shared/inspect.h"
#include "scene/scatter.glsl"
#pragma binding writeonly vec4 surface_points
#pragma binding writeonly vec4 surface_normals

layout(push_constant) uniform Push { SurfaceSettings settings; };

// Glass that a ray passes at most.
const uint LARGEST_PASSED = 16u;
// Share of light transmitted from which on a surface is looked through.
const float SEEN_THROUGH = 0.5;

// Goes on behind glass, without bending.
Hit look_on(Ray ray, Hit hit) {
    for (uint i = 0u; i < LARGEST_PASSED && hit.t < INFINITY; ++i) {
        Surface surface = load_surface(hit);
        if (weigh_dielectric(surface.material) < SEEN_THROUGH) return hit;
        hit = meet_scene(leave_surface(surface, ray.direction), i);
    }
    return hit;
}

void main() {
    if (gl_GlobalInvocationID.x >= settings.count) return;
    uint pixel = settings.first + gl_GlobalInvocationID.x;
    float x = 2.0 * (float(pixel % settings.width) + 0.5) / float(settings.width) - 1.0;
    float y = 1.0 - 2.0 * (float(pixel / settings.width) + 0.5) / float(settings.height);
    vec3 forward = settings.camera.forward.xyz;
    vec3 direction = normalize_safely(forward + x * settings.camera.right.xyz + y * settings.camera.up.xyz);
    Ray ray = Ray(settings.camera.position.xyz, direction);
    Hit hit = meet_scene(ray, pixel);
    if (settings.sees_through != 0u) hit = look_on(ray, hit);
    surface_points[pixel] = vec4(0.0, 0.0, 0.0, INFINITY);
    surface_normals[pixel] = vec4(0.0, 0.0, 0.0, uintBitsToFloat(NO_CELL));
    if (!(hit.t < INFINITY)) return;
    Surface surface = load_surface(hit);
    surface_points[pixel] = vec4(surface.position, dot(surface.position - ray.origin, forward));
    surface_normals[pixel] = vec4(face_smoothly(surface, direction), uintBitsToFloat(surface.object));
}
