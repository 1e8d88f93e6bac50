// SPDX-License-Identifier: Apache-2.0
// Moves each photon and brings it back to the surface it lies on; a border of the surface clips the move. Where there
// is no surface (define HAS_SURFACE) photons stay in their tangent planes.
// Inputs: moves, tree_positions_before, and with a surface power_object, geometry, shading_normals.
// In and out: tree_normals, photon_triangles, constraint_along, constraint_across (turned into the new tangent plane).
// Outputs: tree_positions_after.
#include "shared/prelude.glsl"
#include "shared/math.glsl"
#include "shared/relax.h"
#include "photons/same_surface.glsl"
#include "scene/closest_point.glsl"
#pragma binding texel tree_positions_before
#pragma binding writeonly vec4 tree_positions_after
#pragma binding texel moves
#pragma binding texel power_object
#pragma binding texel shading_normals
#pragma binding coherent vec4 tree_normals
#pragma binding coherent uint photon_triangles
#pragma binding coherent vec4 constraint_along
#pragma binding coherent vec4 constraint_across

layout(push_constant) uniform Push { MoveSettings settings; };

vec3 find_shading_normal(uint triangle, vec3 weights, vec3 fallback) {
    vec3 n = weights.x * shading_normals_at(3u * triangle).xyz + weights.y * shading_normals_at(3u * triangle + 1u).xyz +
             weights.z * shading_normals_at(3u * triangle + 2u).xyz;
    n = normalize_safely(n);
    return n == vec3(0.0) ? fallback : n;
}

vec3 turn_into_plane(vec3 v, vec3 normal) {
    vec3 turned = normalize_safely(v - normal * dot(normal, v));
    return turned == vec3(0.0) ? v : turned;
}

void main() {
    bool valid = gl_GlobalInvocationID.x < settings.count;
    uint position = settings.first + min(gl_GlobalInvocationID.x, settings.count - 1u);
    vec4 photon = tree_positions_before_at(position);
    vec3 move = moves_at(position).xyz;
    vec3 landing = photon.xyz + move;
#ifdef HAS_SURFACE
    uint packed = photon_triangles[position];
    uint triangle = packed & NO_TRIANGLE;
    bool has_triangle = valid && triangle != NO_TRIANGLE;
    float side = (packed & BACK_SIDE) != 0u ? -1.0 : 1.0;
    vec4 old_normal = tree_normals[position];
    uint object = floatBitsToUint(power_object_at(floatBitsToUint(photon.w)).w);
    Sought sought = Sought(landing, side * old_normal.xyz, SAME_SURFACE_COSINE, object);
    uint texel = floatBitsToUint(geometry_at(0u).x) + 3u * (has_triangle ? triangle : 0u);
    // Where the photon came from is that near; its own triangle is preferred to others as near.
    vec4 a = geometry_at(texel), b = geometry_at(texel + 1u), c = geometry_at(texel + 2u);
    vec3 own_normal = find_triangle_normal(a.xyz, b.xyz, c.xyz);
    Closest start = Closest(INFINITY, triangle, photon.xyz, vec3(0.0), false); // a user's own photon may lie a little off
    meet_nearest(a.xyz, b.xyz, c.xyz, triangle, photon.xyz, own_normal, start);
    float reach = sqrt(dot(move, move)) + sqrt(start.distance2);
    Closest best = Closest(reach * reach * 1.001, NO_TRIANGLE, photon.xyz, vec3(0.0), false);
    meet_nearest(a.xyz, b.xyz, c.xyz, triangle, landing, own_normal, best);
    bool has_moved = dot(move, move) > 0.0;
    find_closest(has_triangle && has_moved && !(best.triangle != NO_TRIANGLE && best.is_inside), sought, best);
    if (has_triangle && has_moved && best.triangle != NO_TRIANGLE) {
        landing = best.point;
        vec3 normal = side * find_shading_normal(best.triangle, best.weights, side * old_normal.xyz);
        if (valid) {
            photon_triangles[position] = best.triangle | (packed & BACK_SIDE);
            tree_normals[position] = vec4(normal, old_normal.w);
            vec4 across = constraint_across[position];
            vec3 v = turn_into_plane(across.xyz, normal);
            constraint_across[position] = vec4(v, across.w);
            constraint_along[position].xyz = cross(v, normal);
        }
    } else if (has_triangle) {
        landing = photon.xyz;
    }
#endif
    if (valid) tree_positions_after[position] = vec4(landing, photon.w);
}
