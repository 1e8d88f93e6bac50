// SPDX-License-Identifier: Apache-2.0
// Rays through scenes where some surfaces are not everywhere: alpha masks and blends (glTF 2.0, section 3.9.4).
// Defines: HAS_ALPHA.
#include "scene/surface.glsl"

#ifdef HAS_ALPHA
// Surfaces a ray passes at most where they are not there.
const uint LARGEST_PASSED_ALPHA = 256u;

// Probability that a surface is there.
float find_coverage(Material material) {
    if (material.alpha.y == ALPHA_OPAQUE) return 1.0;
    if (material.alpha.y == ALPHA_MASK) return material.alpha.x >= material.alpha.z ? 1.0 : 0.0;
    return clamp(material.alpha.x, 0.0, 1.0);
}
#endif

// Distance to the nearest surface that lets nothing pass, INFINITY without one.
float find_blocker(Ray ray) {
#ifndef HAS_ALPHA
    return intersect_scene(ray, INFINITY, false).t;
#else
    float passed = 0.0;
    Hit hit = intersect_scene(ray, INFINITY, false);
    for (uint i = 0u; i < LARGEST_PASSED_ALPHA && hit.t < INFINITY; ++i) {
        Surface surface = load_surface(hit);
        if (find_coverage(surface.material) >= 1.0) break;
        passed += hit.t;
        ray = leave_surface(surface, ray.direction);
        hit = intersect_scene(ray, INFINITY, false);
    }
    return hit.t + passed;
#endif
}

// The nearest surface that is there; `random` decides for those of a coverage between 0 and 1.
Hit meet_scene(Ray ray, uint random) {
#ifndef HAS_ALPHA
    return intersect_scene(ray, INFINITY, false);
#else
    float passed = 0.0;
    Hit hit = intersect_scene(ray, INFINITY, false);
    for (uint i = 0u; i < LARGEST_PASSED_ALPHA && hit.t < INFINITY; ++i) {
        Surface surface = load_surface(hit);
        if (to_unit_float(hash_pcg4d(uvec4(random, i, 0u, 0u)).x) < find_coverage(surface.material)) break;
        passed += hit.t;
        hit = intersect_scene(leave_surface(surface, ray.direction), INFINITY, false);
    }
    hit.t += passed;
    return hit;
#endif
}

// Share of light that passes along a ray before `distance`.
float pass_scene(Ray ray, float distance) {
#ifndef HAS_ALPHA
    return intersect_scene(ray, distance, true).t < distance ? 0.0 : 1.0;
#else
    float share = 1.0;
    for (uint i = 0u; i < LARGEST_PASSED_ALPHA && share > 0.0; ++i) {
        Hit hit = intersect_scene(ray, distance, false);
        if (!(hit.t < distance)) return share;
        Surface surface = load_surface(hit);
        share *= 1.0 - find_coverage(surface.material);
        ray = leave_surface(surface, ray.direction);
        distance -= hit.t;
    }
    return share;
#endif
}
