// SPDX-License-Identifier: Apache-2.0
// The surface at a hit: position with its error bound, normals, material; and rays that leave it safely.
// Inputs: shading_normals (3 texels a triangle), materials.
#include "shared/math.glsl"
#include "scene/intersect.glsl"
#pragma binding texel shading_normals
#pragma binding readonly Material materials

// γ₇ of Pharr et al. (7 roundings in the barycentric sum), doubled for the subtraction of the ray's origin.
const float POSITION_ERROR = 14.0 * 5.9604645e-8;

struct Surface {
    vec3 position;
    vec3 error;             // bound on the rounding error of `position`, per axis
    vec3 geometric_normal;  // unit, on the side counter-clockwise triangles show
    vec3 shading_normal;    // unit, as modelled
    uint object;
    Material material;
};

Surface load_surface(Hit hit) {
    vec4 v0 = triangles_at(3u * hit.triangle);
    vec4 v1 = triangles_at(3u * hit.triangle + 1u);
    vec4 v2 = triangles_at(3u * hit.triangle + 2u);
    vec3 weights = vec3(1.0 - hit.b1 - hit.b2, hit.b1, hit.b2);
    Surface surface;
    surface.position = weights.x * v0.xyz + weights.y * v1.xyz + weights.z * v2.xyz;
    surface.error = POSITION_ERROR * (abs(weights.x * v0.xyz) + abs(weights.y * v1.xyz) + abs(weights.z * v2.xyz));
    // Edges are brought to unit size first: the product of tiny ones would underflow.
    vec3 e1 = v1.xyz - v0.xyz;
    vec3 e2 = v2.xyz - v0.xyz;
    float s1 = max(abs(e1.x), max(abs(e1.y), abs(e1.z)));
    float s2 = max(abs(e2.x), max(abs(e2.y), abs(e2.z)));
    surface.geometric_normal = normalize_safely(cross(e1 / s1, e2 / s2));
    vec3 n = weights.x * shading_normals_at(3u * hit.triangle).xyz +
             weights.y * shading_normals_at(3u * hit.triangle + 1u).xyz +
             weights.z * shading_normals_at(3u * hit.triangle + 2u).xyz;
    surface.shading_normal = normalize_safely(n);
    if (surface.shading_normal == vec3(0.0)) surface.shading_normal = surface.geometric_normal;
    surface.object = floatBitsToUint(v0.w);
    surface.material = materials[floatBitsToUint(v1.w)];
    return surface;
}

float step_away(float x, float direction) {
    if (direction == 0.0) return x;
    if (x == 0.0) return direction > 0.0 ? uintBitsToFloat(1u) : uintBitsToFloat(0x80000001u);
    uint bits = floatBitsToUint(x);
    bool grow = (x > 0.0) == (direction > 0.0);
    return uintBitsToFloat(grow ? bits + 1u : bits - 1u);
}

// A ray from the surface whose origin is moved past the position's error, to the side it leaves on (Pharr et al.).
Ray leave_surface(Surface surface, vec3 direction) {
    vec3 n = surface.geometric_normal;
    float distance = dot(abs(n), surface.error);
    vec3 offset = dot(direction, n) < 0.0 ? -distance * n : distance * n;
    vec3 origin = surface.position + offset;
    origin = vec3(step_away(origin.x, offset.x), step_away(origin.y, offset.y), step_away(origin.z, offset.z));
    return Ray(origin, direction);
}
