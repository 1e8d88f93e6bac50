// SPDX-License-Identifier: Apache-2.0
// The point of one object's surface that is nearest to a given point: BVH traversal with a shrinking ball.
// Input: geometry (as in scene/intersect.glsl). Include after shared/prelude.glsl.
#include "shared/scene.h"
#include "shared/trace.h"
#include "shared/turns.glsl"
#pragma binding texel geometry

struct Closest {
    float distance2; // m²; what it began as: nothing nearer was found
    uint triangle;
    vec3 point;
    vec3 weights;    // barycentric
    bool is_inside;  // of the triangle, not on its border
};

// What triangles must be to count.
struct Sought {
    vec3 point;
    vec3 normal;      // their geometric normal lies within …
    float cosine;     // … this of it
    uint object;      // NO_OBJECT: any
};

shared uint closest_stack[BVH_STACK_SIZE * gl_WorkGroupSize.x];

// Edges are brought to unit size first: the product of tiny ones would underflow.
vec3 find_triangle_normal(vec3 v0, vec3 v1, vec3 v2) {
    vec3 a = v1 - v0, b = v2 - v0;
    float s1 = max(abs(a.x), max(abs(a.y), abs(a.z)));
    float s2 = max(abs(b.x), max(abs(b.y), abs(b.z)));
    return normalize_safely(cross(a / s1, b / s2));
}

// Nearest point of the segment from `a` along `edge`, as a share of it.
float find_share(vec3 p, vec3 a, vec3 edge) {
    float length2 = dot(edge, edge);
    return length2 > 0.0 ? clamp(dot(p - a, edge) / length2, 0.0, 1.0) : 0.0;
}

// Takes over the triangle's nearest point if it beats the best so far. Inside, the point is moved along the normal
// alone, so that a photon in the triangle's plane keeps its other coordinates to the bit.
void meet_nearest(vec3 v0, vec3 v1, vec3 v2, uint triangle, vec3 p, vec3 normal, inout Closest best) {
    vec3 e1 = v1 - v0, e2 = v2 - v0, d = p - v0;
    float d11 = dot(e1, e1), d12 = dot(e1, e2), d22 = dot(e2, e2), dp1 = dot(d, e1), dp2 = dot(d, e2);
    float area2 = d11 * d22 - d12 * d12;
    float w1 = (d22 * dp1 - d12 * dp2) / area2;
    float w2 = (d11 * dp2 - d12 * dp1) / area2;
    bool inside = area2 > 0.0 && w1 >= 0.0 && w2 >= 0.0 && w1 + w2 <= 1.0;
    vec3 point = p - normal * dot(normal, d);
    vec3 weights = vec3(1.0 - w1 - w2, w1, w2);
    vec3 off = p - point;
    float distance2 = inside ? dot(off, off) : INFINITY;
    float t01 = find_share(p, v0, e1), t12 = find_share(p, v1, v2 - v1), t20 = find_share(p, v2, v0 - v2);
#define MEET_EDGE(q, w) { vec3 at = q; off = p - at; float d2 = dot(off, off); bool nearer = d2 < distance2; \
        distance2 = nearer ? d2 : distance2; point = nearer ? at : point; weights = nearer ? w : weights; }
    MEET_EDGE(v0 + t01 * e1, vec3(1.0 - t01, t01, 0.0))
    MEET_EDGE(v1 + t12 * (v2 - v1), vec3(0.0, 1.0 - t12, t12))
    MEET_EDGE(v2 + t20 * (v0 - v2), vec3(t20, 0.0, 1.0 - t20))
    if (distance2 < best.distance2) best = Closest(distance2, triangle, point, weights, inside);
}

float measure_box_distance(vec3 lo, vec3 hi, vec3 p) {
    vec3 d = max(max(lo - p, p - hi), vec3(0.0));
    return dot(d, d);
}

uint pack_box(vec4 lo, vec4 hi) { return floatBitsToUint(lo.w) | floatBitsToUint(hi.w) << 28u; }

void try_triangle(uint triangle, vec4 a, vec4 b, vec4 c, Sought sought, inout Closest best) {
    vec3 normal = find_triangle_normal(a.xyz, b.xyz, c.xyz);
    bool counts = dot(normal, sought.normal) > sought.cosine &&
                  (sought.object == NO_OBJECT || floatBitsToUint(a.w) == sought.object);
    if (counts) meet_nearest(a.xyz, b.xyz, c.xyz, triangle, sought.point, normal, best);
}

// Improves on `best`, whose distance2 bounds the search. Without turns left the search was given up.
void find_closest(bool searching, Sought sought, inout Closest best) {
    uint triangle_texels = floatBitsToUint(geometry_at(0u).x);
    uint node = pack_box(geometry_at(1u), geometry_at(2u));
    uint base = gl_LocalInvocationIndex, stack = base;
    bool alive = searching;
    while (alive) {
        ++turns;
        uint first = node & 0x0fffffffu;
        uint count = node >> 28u;
        bool is_leaf = count > 0u;
        uint texel = is_leaf ? triangle_texels + 3u * first : 1u + 2u * first;
        vec4 a = geometry_at(texel), b = geometry_at(texel + 1u), c = geometry_at(texel + 2u), d = geometry_at(texel + 3u);
        bool pop = true;
        if (is_leaf) {
            try_triangle(first, a, b, c, sought, best);
            pop = count == 1u;
            node = (first + 1u) | (count - 1u) << 28u;
        } else {
            float d0 = measure_box_distance(a.xyz, b.xyz, sought.point);
            float d1 = measure_box_distance(c.xyz, d.xyz, sought.point);
            bool swap = d1 < d0;
            if (max(d0, d1) <= best.distance2) {
                closest_stack[stack] = swap ? pack_box(a, b) : pack_box(c, d);
                stack += gl_WorkGroupSize.x;
            }
            pop = min(d0, d1) > best.distance2;
            node = swap ? pack_box(c, d) : pack_box(a, b);
        }
        if (pop) {
            alive = stack > base;
            stack -= alive ? gl_WorkGroupSize.x : 0u;
            node = closest_stack[stack];
        }
        alive = alive && has_turns_left();
    }
}
