// SPDX-License-Identifier: Apache-2.0
// Ray against scene: BVH traversal with a stack in shared memory, watertight triangles (Woop, Benthin, Wald 2013).
// Input: geometry, texels: one SceneHeader, the BVH nodes (2 texels each), the triangles (3 texels each).
// One loop goes down to a leaf, another through its triangles: on SIMD without branches every lane pays for every load in a
// loop, whatever it meets there.
#include "shared/scene.h"
#include "shared/turns.glsl"
#pragma binding texel geometry

// Bound on the rounding error of a point on a triangle and of meeting the triangle again from there, as a share of
// the triangle's largest coordinate: 7 roundings in the barycentric sum, 7 in the intersection, doubled.
const float POSITION_ERROR = 28.0 * 5.9604645e-8;

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

shared uint traversal_stack[BVH_STACK_SIZE * gl_WorkGroupSize.x]; // packed nodes that wait

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

// Watertight: neighbors that share an edge compute its function from the same bits with the sign reversed.
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
    bool outside = (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0);
    precise float det = u + v + w;
    precise float t = (u * a.z + v * b.z + w * c.z) * ray.shear.z / det;
    bool met = !outside && det != 0.0 && t > 0.0 && t < hit.t;
    if (met) {
        hit.t = t;
        hit.b1 = v / det;
        hit.b2 = w / det;
    }
    return met;
}

const uint PACKED_COUNT_SHIFT = 28u;

// A node in one word: what it points to and, for a leaf, how many triangles.
uint pack_node(vec4 lo, vec4 hi) { return floatBitsToUint(lo.w) | floatBitsToUint(hi.w) << PACKED_COUNT_SHIFT; }

// Nearest hit before `t_max`; with `any_hit` the first one found. Without turns left the search was given up.
Hit intersect_scene(Ray ray, float t_max, bool any_hit) {
    Hit hit = Hit(t_max, 0u, 0.0, 0.0);
    bool found = false;
    vec3 inverse = invert_direction(ray.direction);
    ShearedRay sheared = shear_ray(ray.direction);
    uint triangle_texels = floatBitsToUint(geometry_at(0u).x);
    vec4 root_lo = geometry_at(1u);
    vec4 root_hi = geometry_at(2u);
    uint node = pack_node(root_lo, root_hi);
    uint stack = gl_LocalInvocationIndex;
    uint base = stack;
    bool alive = enter_box(root_lo.xyz, root_hi.xyz, ray.origin, inverse, t_max) < INFINITY;
    while (alive) {
        // Down to the next leaf, or out.
        while (alive && (node >> PACKED_COUNT_SHIFT) == 0u) {
            ++turns;
            uint texel = 1u + 2u * node;
            vec4 a = geometry_at(texel);
            vec4 b = geometry_at(texel + 1u);
            vec4 c = geometry_at(texel + 2u);
            vec4 d = geometry_at(texel + 3u);
            float t0 = enter_box(a.xyz, b.xyz, ray.origin, inverse, hit.t);
            float t1 = enter_box(c.xyz, d.xyz, ray.origin, inverse, hit.t);
            bool swap = t1 < t0;
            if (max(t0, t1) < INFINITY) {
                traversal_stack[stack] = swap ? pack_node(a, b) : pack_node(c, d);
                stack += gl_WorkGroupSize.x;
            }
            node = swap ? pack_node(c, d) : pack_node(a, b);
            if (min(t0, t1) == INFINITY) {
                alive = stack > base;
                stack -= alive ? gl_WorkGroupSize.x : 0u;
                node = traversal_stack[stack];
            }
            alive = alive && has_turns_left();
        }
        uint first = node & ((1u << PACKED_COUNT_SHIFT) - 1u);
        uint end = first + (node >> PACKED_COUNT_SHIFT);
        while (alive && first < end) {
            ++turns;
            uint texel = triangle_texels + 3u * first;
            vec3 v0 = geometry_at(texel).xyz;
            vec3 v1 = geometry_at(texel + 1u).xyz;
            vec3 v2 = geometry_at(texel + 2u).xyz;
            if (meet_triangle(v0, v1, v2, ray.origin, sheared, hit)) {
                hit.triangle = first;
                found = true;
            }
            ++first;
        }
        // A leaf behind the nearest hit so far is taken all the same: its triangles are missed.
        bool more = stack > base && !(any_hit && found);
        stack -= more ? gl_WorkGroupSize.x : 0u;
        node = traversal_stack[stack];
        alive = alive && more && has_turns_left();
    }
    if (!found) hit.t = INFINITY;
    return hit;
}

// One corner of a triangle: xyz position; w object, material or source index as bits.
vec4 load_corner(uint triangle, uint corner) {
    return geometry_at(floatBitsToUint(geometry_at(0u).x) + 3u * triangle + corner);
}
