// SPDX-License-Identifier: Apache-2.0
// What a surface does to light: Lambert, perfect mirror with Schlick reflectance, smooth dielectric with exact Fresnel.
// Sides are decided by the geometric normal, directions by the shading normal (METHODS §0).
#include "scene/surface.glsl"

float weigh_diffuse(Material m) { return (1.0 - m.base_color_metallic.w) * (1.0 - m.emission_transmission.w); }
float weigh_mirror(Material m) { return m.base_color_metallic.w; }
float weigh_dielectric(Material m) { return (1.0 - m.base_color_metallic.w) * m.emission_transmission.w; }
bool is_thin(Material m) { return m.roughness_thin.y > 0.0; }

// The normal for directions: the shading normal on the arriving side, or the geometric one where it would face away.
vec3 face_arrival(Surface surface, vec3 direction) {
    vec3 g = dot(direction, surface.geometric_normal) > 0.0 ? -surface.geometric_normal : surface.geometric_normal;
    vec3 s = dot(surface.shading_normal, g) < 0.0 ? -surface.shading_normal : surface.shading_normal;
    return dot(direction, s) < 0.0 ? s : g;
}

vec3 reflect_direction(Surface surface, vec3 direction) {
    vec3 n = face_arrival(surface, direction);
    vec3 reflected = normalize_safely(reflect(direction, n));
    bool arrives_in_front = dot(direction, surface.geometric_normal) < 0.0;
    bool leaves_in_front = dot(reflected, surface.geometric_normal) > 0.0;
    if (arrives_in_front == leaves_in_front) return reflected;
    // A bent shading normal would send it through the surface: the geometric one cannot.
    return normalize_safely(reflect(direction, surface.geometric_normal));
}

vec3 reflect_schlick(Material m, float cosine) {
    float x = clamp(1.0 - cosine, 0.0, 1.0);
    vec3 f0 = m.base_color_metallic.rgb;
    return f0 + (1.0 - f0) * (x * x * x * x * x);
}

// Exact unpolarized Fresnel reflectance; `ratio` is index here over index beyond. 1 for total internal reflection.
float reflect_fresnel(float cosine, float ratio, out float cosine_beyond) {
    float sine2 = ratio * ratio * max(0.0, 1.0 - cosine * cosine);
    cosine_beyond = 0.0;
    if (sine2 >= 1.0) return 1.0;
    cosine_beyond = sqrt(1.0 - sine2);
    float parallel = (cosine - ratio * cosine_beyond) / (cosine + ratio * cosine_beyond);
    float perpendicular = (ratio * cosine - cosine_beyond) / (ratio * cosine + cosine_beyond);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

struct Interface {
    float reflectance;
    vec3 transmitted; // direction beyond; meaningless when reflectance is 1
};

Interface meet_dielectric(Surface surface, vec3 direction) {
    bool enters = dot(direction, surface.geometric_normal) < 0.0;
    float ior = surface.material.absorption_ior.w;
    float ratio = enters ? 1.0 / ior : ior;
    vec3 n = face_arrival(surface, direction);
    float cosine = min(1.0, -dot(direction, n));
    float beyond;
    Interface result;
    if (is_thin(surface.material)) { // both faces at once: R' = 2R/(1 + R), no bending
        float r = reflect_fresnel(cosine, 1.0 / ior, beyond);
        result.reflectance = 2.0 * r / (1.0 + r);
        result.transmitted = direction;
        return result;
    }
    result.reflectance = reflect_fresnel(cosine, ratio, beyond);
    result.transmitted = normalize_safely(ratio * direction + (ratio * cosine - beyond) * n);
    // A bent shading normal that would keep it on this side: let it pass along the surface's own normal.
    if (result.reflectance < 1.0 && (dot(result.transmitted, surface.geometric_normal) < 0.0) != enters) {
        vec3 g = enters ? surface.geometric_normal : -surface.geometric_normal;
        float geometric_cosine = min(1.0, -dot(direction, g));
        result.reflectance = reflect_fresnel(geometric_cosine, ratio, beyond);
        result.transmitted = normalize_safely(ratio * direction + (ratio * geometric_cosine - beyond) * g);
    }
    return result;
}

// Transmittance of the segment that ended here, if it ran inside this surface's dielectric (Beer-Lambert).
vec3 transmit_interior(Surface surface, vec3 direction, float distance) {
    bool inside = weigh_dielectric(surface.material) > 0.0 && !is_thin(surface.material) &&
                  dot(direction, surface.geometric_normal) > 0.0;
    if (!inside) return vec3(1.0);
    vec3 depth = -surface.material.absorption_ior.rgb * distance;
    return vec3(exp_exact(depth.r), exp_exact(depth.g), exp_exact(depth.b));
}
