// SPDX-License-Identifier: Apache-2.0
// What a surface does to light: Lambert, mirror with Schlick reflectance, dielectric with exact Fresnel, both smooth or
// rough. Sides are decided by the geometric normal, directions by the shading normal (METHODS §0).
// Over them a gloss and a coat, each a layer that reflects what its Fresnel says and lets the rest through.
// Defines: HAS_ROUGH, HAS_LAYERS, HAS_DISPERSION, HAS_MEDIA.
#include "scene/coverage.glsl"
#ifdef HAS_ROUGH
#include "scene/microfacet.glsl"
#endif

float weigh_diffuse(Material m) { return (1.0 - m.base_color_metallic.w) * (1.0 - m.emission_transmission.w); }
float weigh_mirror(Material m) { return m.base_color_metallic.w; }
float weigh_dielectric(Material m) { return (1.0 - m.base_color_metallic.w) * m.emission_transmission.w; }
bool is_thin(Material m) { return m.roughness_thin.y > 0.0; }

// A normal of the surface on the arriving side, or the geometric one where it would face away.
vec3 face_normal(Surface surface, vec3 normal, vec3 direction) {
    vec3 g = dot(direction, surface.geometric_normal) > 0.0 ? -surface.geometric_normal : surface.geometric_normal;
    vec3 s = dot(normal, g) < 0.0 ? -normal : normal;
    return dot(direction, s) < 0.0 ? s : g;
}

// For directions.
vec3 face_arrival(Surface surface, vec3 direction) { return face_normal(surface, surface.shading_normal, direction); }

// For what is stored and looked for: as the surface is modelled.
vec3 face_smoothly(Surface surface, vec3 direction) { return face_normal(surface, surface.smooth_normal, direction); }

// Cosine-weighted about a normal; what a bent one would send through the surface is mirrored at it.
vec3 leave_diffusely(Surface surface, vec3 normal, float u1, float u2) {
    vec3 direction = sample_cosine(normal, u1, u2);
    float across = dot(direction, surface.geometric_normal);
    bool crosses = across * dot(normal, surface.geometric_normal) < 0.0;
    return crosses ? direction - 2.0 * across * surface.geometric_normal : direction;
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

vec3 reflect_schlick(vec3 f0, float f90, float cosine) {
    float x = clamp(1.0 - cosine, 0.0, 1.0);
    return f0 + (f90 - f0) * (x * x * x * x * x);
}

#ifdef HAS_LAYERS
// A coat's index is 1.5.
const vec3 COAT_REFLECTANCE = vec3(0.04);

float find_largest(vec3 v) { return max(v.r, max(v.g, v.b)); }
#endif

#ifdef HAS_DISPERSION
// Of a place in the spectrum from 400 to 700 nm, what white light has there: the mean over all places is white.
vec3 color_band(float band) {
    float red = clamp(3.0 * band - 1.5, 0.0, 1.0);
    float blue = clamp(1.5 - 3.0 * band, 0.0, 1.0);
    return 3.0 * vec3(red, 1.0 - red - blue, blue);
}

// Cauchy's A + B/λ² through the index at the d line with the Abbe number 20 / dispersion (KHR_materials_dispersion).
float find_index(Material material, float band) {
    float nanometres = 400.0 + 300.0 * band;
    float ior = material.absorption_ior.w;
    float spread = (ior - 1.0) * material.alpha.w / 20.0; // between the F and C lines, 486.1 and 656.3 nm
    float steepness = spread / (1.0 / (486.1 * 486.1) - 1.0 / (656.3 * 656.3));
    return max(1.0, ior + steepness * (1.0 / (nanometres * nanometres) - 1.0 / (587.6 * 587.6)));
}
#endif

// What becomes of arriving light; the rest meets the dielectric.
struct LobeShares {
    float diffuse, mirror, gloss, coat;
};

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

bool arrives_in_front(Surface surface, vec3 direction) { return dot(direction, surface.geometric_normal) < 0.0; }

LobeShares share_lobes(Surface surface, vec3 direction) {
    Material m = surface.material;
    LobeShares shares = LobeShares(weigh_diffuse(m), weigh_mirror(m), 0.0, 0.0);
#ifdef HAS_LAYERS
    float cosine = -dot(direction, face_arrival(surface, direction));
    shares.coat = m.coat.x * find_largest(reflect_schlick(COAT_REFLECTANCE, 1.0, cosine));
    shares.mirror *= 1.0 - shares.coat;
    shares.gloss = shares.diffuse * (1.0 - shares.coat) * find_largest(reflect_schlick(m.gloss.rgb, m.gloss.w, cosine));
    shares.diffuse = shares.diffuse * (1.0 - shares.coat) - shares.gloss;
#endif
    return shares;
}

#ifdef HAS_ROUGH
bool is_rough(Material m) { return m.roughness_thin.x > 0.0; }

bool has_rough_lobe(Material m) {
#ifdef HAS_LAYERS
    if (m.coat.x > 0.0 && m.coat.y > 0.0) return true;
#endif
    return is_rough(m);
}

// The frame of a rough surface's facets; its z axis is the normal that light arrives on.
struct FacetFrame {
    vec3 u, v, n;
    vec3 arriving; // in the frame, away from the surface
    float width;
};

FacetFrame build_facet_frame(Surface surface, vec3 direction, float roughness) {
    FacetFrame frame;
    frame.n = face_arrival(surface, direction);
    build_basis(frame.n, frame.u, frame.v);
    frame.arriving = -vec3(dot(direction, frame.u), dot(direction, frame.v), dot(direction, frame.n));
    frame.arriving.z = max(frame.arriving.z, 1e-7);
    frame.width = find_ggx_width(roughness);
    return frame;
}

vec3 turn_to_facets(FacetFrame frame, vec3 w) { return vec3(dot(w, frame.u), dot(w, frame.v), dot(w, frame.n)); }

vec3 turn_to_world(FacetFrame frame, vec3 w) { return normalize_safely(w.x * frame.u + w.y * frame.v + w.z * frame.n); }

// Share of what a facet sends to `leaving` that other facets and the surface itself let pass; `side` 1 where it stays, -1 beyond.
float share_leaving(Surface surface, vec3 direction, FacetFrame frame, vec3 leaving, float side) {
    bool stays = arrives_in_front(surface, direction) == (dot(turn_to_world(frame, leaving), surface.geometric_normal) > 0.0);
    if (leaving.z * side <= 0.0 || stays != (side > 0.0)) return 0.0;
    return share_visible(frame.arriving, leaving, frame.width);
}
#endif

// A direction that light takes, and what the surface leaves of it.
struct Lobe {
    vec3 direction;
    vec3 share;
};

// Off facets of Schlick's reflectance; u in [0, 1)² chooses one of a rough surface.
Lobe reflect_facets(Surface surface, vec3 direction, vec2 u, float roughness, vec3 f0, float f90) {
#ifdef HAS_ROUGH
    if (roughness > 0.0) {
        FacetFrame frame = build_facet_frame(surface, direction, roughness);
        vec3 m = sample_visible_facet(frame.arriving, frame.width, u);
        vec3 leaving = reflect(-frame.arriving, m);
        return Lobe(turn_to_world(frame, leaving), share_leaving(surface, direction, frame, leaving, 1.0) *
                                                       reflect_schlick(f0, f90, dot(frame.arriving, m)));
    }
#endif
    return Lobe(reflect_direction(surface, direction), reflect_schlick(f0, f90, -dot(direction, face_arrival(surface, direction))));
}

Lobe reflect_metal(Surface surface, vec3 direction, vec2 u) {
    Material m = surface.material;
    return reflect_facets(surface, direction, u, m.roughness_thin.x, m.base_color_metallic.rgb, 1.0);
}

#ifdef HAS_LAYERS
// The layers' lobes are chosen by their reflectance at the whole surface, which the shares make up for.
Lobe reflect_gloss(Surface surface, vec3 direction, vec2 u, LobeShares shares) {
    Material m = surface.material;
    Lobe lobe = reflect_facets(surface, direction, u, m.roughness_thin.x, m.gloss.rgb, m.gloss.w);
    lobe.share *= weigh_diffuse(m) * (1.0 - shares.coat) / shares.gloss;
    return lobe;
}

Lobe reflect_coat(Surface surface, vec3 direction, vec2 u, LobeShares shares) {
    Material m = surface.material;
    Lobe lobe = reflect_facets(surface, direction, u, m.coat.y, COAT_REFLECTANCE, 1.0);
    lobe.share *= m.coat.x / shares.coat;
    return lobe;
}
#endif

// What a dielectric does to one arriving direction. Shares: of what is reflected or transmitted, what leaves.
struct Interface {
    float reflectance;
    vec3 reflected;
    float reflected_share;
    vec3 transmitted; // meaningless when reflectance is 1
    float transmitted_share;
};

// Index of refraction here over that beyond.
float find_index_ratio(Surface surface, vec3 direction) {
    float ior = surface.material.absorption_ior.w;
    return arrives_in_front(surface, direction) ? 1.0 / ior : ior;
}

// Both faces of a thin one at once: R' = 2R/(1 + R).
float reflect_thin(float cosine, float ior) {
    float beyond;
    float r = reflect_fresnel(cosine, 1.0 / ior, beyond);
    return 2.0 * r / (1.0 + r);
}

vec3 refract_direction(vec3 direction, vec3 n, float cosine, float ratio, float beyond) {
    return normalize_safely(ratio * direction + (ratio * cosine - beyond) * n);
}

Interface meet_smooth(Surface surface, vec3 direction) {
    float ratio = find_index_ratio(surface, direction);
    vec3 n = face_arrival(surface, direction);
    float cosine = min(1.0, -dot(direction, n));
    float beyond;
    Interface face = Interface(0.0, reflect_direction(surface, direction), 1.0, direction, 1.0);
    if (is_thin(surface.material)) { // no bending
        face.reflectance = reflect_thin(cosine, surface.material.absorption_ior.w);
        return face;
    }
#ifdef HAS_MEDIA
    if (surface.material.absorption_ior.w == 1.0) return face; // nothing happens at the border of a fog
#endif
    face.reflectance = reflect_fresnel(cosine, ratio, beyond);
    face.transmitted = refract_direction(direction, n, cosine, ratio, beyond);
    bool enters = arrives_in_front(surface, direction);
    // A bent shading normal that would keep it on this side: let it pass along the surface's own normal.
    if (face.reflectance < 1.0 && arrives_in_front(surface, face.transmitted) != enters) {
        vec3 g = enters ? surface.geometric_normal : -surface.geometric_normal;
        float geometric_cosine = min(1.0, -dot(direction, g));
        face.reflectance = reflect_fresnel(geometric_cosine, ratio, beyond);
        face.transmitted = refract_direction(direction, g, geometric_cosine, ratio, beyond);
    }
    return face;
}

#ifdef HAS_ROUGH
// One facet decides both directions. Thin: what is transmitted is the reflection's mirror image behind the surface.
Interface meet_facet(Surface surface, vec3 direction, vec2 u) {
    FacetFrame frame = build_facet_frame(surface, direction, surface.material.roughness_thin.x);
    vec3 m = sample_visible_facet(frame.arriving, frame.width, u);
    float cosine = clamp(dot(frame.arriving, m), 0.0, 1.0);
    vec3 reflected = reflect(-frame.arriving, m);
    vec3 transmitted = vec3(reflected.xy, -reflected.z);
    Interface face;
    if (is_thin(surface.material)) {
        face.reflectance = reflect_thin(cosine, surface.material.absorption_ior.w);
    } else {
        float beyond, ratio = find_index_ratio(surface, direction);
        face.reflectance = reflect_fresnel(cosine, ratio, beyond);
        transmitted = refract_direction(-frame.arriving, m, cosine, ratio, beyond);
    }
    face.reflected = turn_to_world(frame, reflected);
    face.reflected_share = share_leaving(surface, direction, frame, reflected, 1.0);
    face.transmitted = turn_to_world(frame, transmitted);
    face.transmitted_share = share_leaving(surface, direction, frame, transmitted, -1.0);
    return face;
}

// Light per steradian that facets send from `direction` to `leaving`, mirrored, of what arrives: the density of the
// sampling above times its shares.
vec3 mirror_facets(Surface surface, vec3 direction, vec3 leaving, float roughness, vec3 f0, float f90) {
    if (!(roughness > 0.0)) return vec3(0.0);
    FacetFrame frame = build_facet_frame(surface, direction, roughness);
    vec3 w = turn_to_facets(frame, leaving);
    vec3 m = normalize_safely(frame.arriving + w);
    float share = share_leaving(surface, direction, frame, w, 1.0);
    if (share <= 0.0) return vec3(0.0);
    float density = find_visible_density(frame.arriving, m, frame.width) * measure_reflection(frame.arriving, m);
    return share * density * reflect_schlick(f0, f90, dot(frame.arriving, m));
}

// The same of a dielectric, mirrored or refracted. Its color is left out on reflection, as everywhere.
vec3 cross_facets(Surface surface, vec3 direction, vec3 leaving) {
    Material material = surface.material;
    if (!is_rough(material) || weigh_dielectric(material) <= 0.0) return vec3(0.0);
    FacetFrame frame = build_facet_frame(surface, direction, material.roughness_thin.x);
    vec3 w = turn_to_facets(frame, leaving);
    float side = w.z > 0.0 ? 1.0 : -1.0;
    float share = share_leaving(surface, direction, frame, w, side);
    if (share <= 0.0) return vec3(0.0);
    bool is_mirrored = side > 0.0 || is_thin(material);
    vec3 image = is_thin(material) ? vec3(w.xy, abs(w.z)) : w;
    float ratio = find_index_ratio(surface, direction);
    vec3 m = is_mirrored ? normalize_safely(frame.arriving + image) : find_refracting_facet(frame.arriving, w, ratio);
    float cosine = dot(frame.arriving, m);
    if (cosine <= 0.0 || (!is_mirrored && dot(w, m) >= 0.0)) return vec3(0.0);
    float density = find_visible_density(frame.arriving, m, frame.width) *
                    (is_mirrored ? measure_reflection(frame.arriving, m) : measure_refraction(frame.arriving, w, m, ratio));
    float beyond;
    float reflectance = is_thin(material) ? reflect_thin(cosine, material.absorption_ior.w) : reflect_fresnel(cosine, ratio, beyond);
    return share * density * (side > 0.0 ? vec3(reflectance) : (1.0 - reflectance) * material.base_color_metallic.rgb);
}

// Of all rough lobes.
vec3 scatter_rough(Surface surface, vec3 direction, vec3 leaving) {
    Material m = surface.material;
    LobeShares shares = share_lobes(surface, direction);
    vec3 sum = weigh_dielectric(m) * cross_facets(surface, direction, leaving) +
               weigh_mirror(m) * mirror_facets(surface, direction, leaving, m.roughness_thin.x, m.base_color_metallic.rgb, 1.0);
#ifdef HAS_LAYERS
    sum += weigh_diffuse(m) * mirror_facets(surface, direction, leaving, m.roughness_thin.x, m.gloss.rgb, m.gloss.w);
    sum *= 1.0 - shares.coat;
    sum += m.coat.x * mirror_facets(surface, direction, leaving, m.coat.y, COAT_REFLECTANCE, 1.0);
#endif
    return sum;
}
#endif

Interface meet_dielectric(Surface surface, vec3 direction, vec2 u) {
#ifdef HAS_ROUGH
    if (is_rough(surface.material)) return meet_facet(surface, direction, u);
#endif
    return meet_smooth(surface, direction);
}

#ifdef HAS_MEDIA
#include "scene/medium.glsl"
#endif

// Transmittance of the segment that ended here, if it ran inside this surface's dielectric (Beer-Lambert).
vec3 transmit_interior(Surface surface, vec3 direction, float distance) {
    bool inside = weigh_dielectric(surface.material) > 0.0 && !is_thin(surface.material) &&
                  dot(direction, surface.geometric_normal) > 0.0;
    if (!inside) return vec3(1.0);
    vec3 depth = -surface.material.absorption_ior.rgb * distance;
    return vec3(exp_exact(depth.r), exp_exact(depth.g), exp_exact(depth.b));
}
