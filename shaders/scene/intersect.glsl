// SPDX-License-Identifier: Apache-2.0
// Ray against scene: BVH traversal with a stack in shared memory, watertight triangles (Woop, Benthin, Wald 2013).
// Inputs: nodes (2 texels each), triangles (3 texels each). Define HAS_SCENE_RAYS's stack once per kernel.
#include "shared/scene.h"
#pragma binding texel nodes
#pragma binding texel triangles

struct Ray {
    vec3 origin;
    vec3 direction; // unit
};

struct Hit {
    float t;        // metres; INFINITY: nothing was met
    uint triangle;
    float b1;       // barycentric weights of vertices 1 and 2
    float b2;
};

shared uint traversal_stack[BVH_STACK_SIZE * gl_WorkGroupSize.x];

// Slab test bound: (1 + 2 γ₃) of Ize 2013, so that rounding never loses a box.
const float SLAB_SLACK = 1.0000004;
// Stands in for a zero direction component: its reciprocal is finite, so no 0 · inf appears.
const float SMALLEST_COMPONENT = 1e-30;

vec3 invert_direction(vec3 d) {
    return 1.0 / mix(d, mix(vec3(-SMALLEST_COMPONENT), vec3(SMALLEST_COMPONENT), greaterThanEqual(d, vec3(0.0))),
                     lessThan(abs(d), vec3(SMALLEST_COMPONENT)));
}

// Entry distance into a box, INFINITY if it is missed or lies beyond `t_max`.
float enter_box(vec3 lo, vec3 hi, vec3 origin, vec3 inverse, float t_max) {
    vec3 a = (lo - origin) * inverse;
    vec3 b = (hi - origin) * inverse;
    vec3 near = min(a, b);
    vec3 far = max(a, b);
    float enter = max(max(near.x, near.y), max(near.z, 0.0));
    float leave = min(min(far.x, far.y), min(far.z, t_max)) * SLAB_SLACK;
    return enter <= leave ? enter : INFINITY;
}

// The ray's frame with the dominant axis last, and the shear that makes it (0, 0, 1).
struct ShearedRay {
    uint axis;
    vec3 shear;
};

vec3 permute(vec3 v, uint axis) { return axis == 0u ? v.yzx : (axis == 1u ? v.zxy : v); }

ShearedRay shear_ray(vec3 d) {
    vec3 a = abs(d);
    uint axis = a.x > a.y && a.x > a.z ? 0u : (a.y > a.z ? 1u : 2u);
    vec3 p = permute(d, axis);
    return ShearedRay(axis, vec3(p.x / p.z, p.y / p.z, 1.0 / p.z));
}

// Watertight: neighbours that share an edge compute its function from the same bits with the sign reversed.
bool meet_triangle(vec3 v0, vec3 v1, vec3 v2, vec3 origin, ShearedRay ray, inout Hit hit) {
    vec3 a = permute(v0 - origin, ray.axis);
    vec3 b = permute(v1 - origin, ray.axis);
    vec3 c = permute(v2 - origin, ray.axis);
    precise vec2 p = a.xy - ray.shear.xy * a.z;
    precise vec2 q = b.xy - ray.shear.xy * b.z;
    precise vec2 r = c.xy - ray.shear.xy * c.z;
    precise float u = r.x * q.y - r.y * q.x;
    precise float v = p.x * r.y - p.y * r.x;
    precise float w = q.x * p.y - q.y * p.x;
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return false;
    precise float det = u + v + w;
    if (det == 0.0) return false;
    precise float t = (u * a.z + v * b.z + w * c.z) * ray.shear.z / det;
    if (!(t > 0.0 && t < hit.t)) return false;
    hit.t = t;
    hit.b1 = v / det;
    hit.b2 = w / det;
    return true;
}

// Nearest hit before `t_max`; with `any_hit` the first one found.
Hit intersect_scene(Ray ray, float t_max, bool any_hit) {
    Hit hit = Hit(t_max, 0u, 0.0, 0.0);
    bool found = false;
    vec3 inverse = invert_direction(ray.direction);
    ShearedRay sheared = shear_ray(ray.direction);
    uint stack_at = gl_LocalInvocationIndex;
    uint depth = 0u;
    vec4 lo = nodes_at(0u);
    vec4 hi = nodes_at(1u);
    uint first = floatBitsToUint(lo.w);
    uint count = floatBitsToUint(hi.w);
    if (enter_box(lo.xyz, hi.xyz, ray.origin, inverse, t_max) == INFINITY) return Hit(INFINITY, 0u, 0.0, 0.0);
    while (true) {
        if (count > 0u) {
            for (uint i = first; i < first + count; ++i) {
                vec3 v0 = triangles_at(3u * i).xyz;
                vec3 v1 = triangles_at(3u * i + 1u).xyz;
                vec3 v2 = triangles_at(3u * i + 2u).xyz;
                if (meet_triangle(v0, v1, v2, ray.origin, sheared, hit)) {
                    hit.triangle = i;
                    found = true;
                }
            }
            if (any_hit && found) break;
            count = 0u;
        } else {
            vec4 lo0 = nodes_at(2u * first);
            vec4 hi0 = nodes_at(2u * first + 1u);
            vec4 lo1 = nodes_at(2u * first + 2u);
            vec4 hi1 = nodes_at(2u * first + 3u);
            float t0 = enter_box(lo0.xyz, hi0.xyz, ray.origin, inverse, hit.t);
            float t1 = enter_box(lo1.xyz, hi1.xyz, ray.origin, inverse, hit.t);
            bool swap = t1 < t0;
            float near = swap ? t1 : t0;
            float far = swap ? t0 : t1;
            if (far < INFINITY) {
                traversal_stack[stack_at + gl_WorkGroupSize.x * depth] = 2u * first + (swap ? 0u : 2u);
                ++depth;
            }
            if (near < INFINITY) {
                first = floatBitsToUint(swap ? lo1.w : lo0.w);
                count = floatBitsToUint(swap ? hi1.w : hi0.w);
                continue;
            }
        }
        bool resumed = false;
        while (depth > 0u && !resumed) {
            --depth;
            uint texel = traversal_stack[stack_at + gl_WorkGroupSize.x * depth];
            lo = nodes_at(texel);
            hi = nodes_at(texel + 1u);
            resumed = enter_box(lo.xyz, hi.xyz, ray.origin, inverse, hit.t) < INFINITY;
        }
        if (!resumed) break;
        first = floatBitsToUint(lo.w);
        count = floatBitsToUint(hi.w);
    }
    if (!found) hit.t = INFINITY;
    return hit;
}
