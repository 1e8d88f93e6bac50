// SPDX-License-Identifier: Apache-2.0
// Irradiance that lights send straight to each eye hit; every surface, glass too, blocks it (METHODS §0). Area lights by
// one point of theirs for each sample of a pixel, spread over their area by the Sobol sequence.
// Inputs: scene, lights, emitting, environment_map, hit_point, hit_normal, hit_weight. Output: direct_irradiance.
// Defines: HAS_SPOT_LIGHTS, HAS_DIRECTIONAL_LIGHTS, HAS_AREA_LIGHTS, HAS_ENVIRONMENT, HAS_ENVIRONMENT_MAP; HAS_ALPHA,
// HAS_TEXTURES, HAS_VERTEX_COLORS, HAS_MEDIA (fog weakens, glass blocks).
#include "shared/prelude.glsl"
#include "shared/random.h"
#include "shared/render.h"
#include "scene/coverage.glsl"
#ifdef HAS_MEDIA
#include "scene/scatter.glsl"
#endif
#ifdef HAS_AREA_LIGHTS
#include "scene/emitting.glsl"
#endif
#ifdef HAS_ENVIRONMENT_MAP
#include "scene/environment.glsl"
#endif
#include "estimate/light_beams.glsl"
#pragma binding texel hit_point
#pragma binding texel hit_normal
#pragma binding texel hit_weight
#pragma binding writeonly vec4 direct_irradiance

layout(push_constant) uniform Push { FilmSettings settings; };

// A ray to an area light is stopped short of it by this share of its length.
const float BEFORE_LIGHT = 0.9999;

uint hit_medium = 0u; // that the point lies in, as Media::inner

vec3 pass_straight(Ray ray, float distance) {
#ifdef HAS_MEDIA
    return pass_media(ray, distance, Media(hit_medium, 0u), true);
#else
    return vec3(pass_scene(ray, distance));
#endif
}

vec3 light_from(Light light, vec3 point, vec3 normal) {
    Beam beam;
    if (!find_beam(light, point, beam)) return vec3(0.0);
    float cosine = dot(beam.direction, normal);
    if (cosine <= 0.0) return vec3(0.0);
    return beam.irradiance * (cosine * pass_straight(Ray(point, beam.direction), beam.distance));
}

#ifdef HAS_AREA_LIGHTS
vec3 light_area(Light light, vec3 point, vec3 normal, vec3 u) {
    EmittingPoint from = sample_emitting(floatBitsToUint(light.cone.y), floatBitsToUint(light.cone.z), u.z, u.xy);
    vec3 direction;
    float distance;
    if (!aim_at(from.position - point, direction, distance)) return vec3(0.0);
    float cosine = dot(direction, normal);
    float leaving = -dot(direction, from.normal);
    if (light.cone.w > 1.0) leaving = abs(leaving);
    if (cosine <= 0.0 || leaving <= 0.0) return vec3(0.0);
    vec3 share = cosine * pass_straight(Ray(point, direction), distance * BEFORE_LIGHT);
    return light.intensity.rgb * from.tint * (light.cone.x * leaving / distance / distance) * share;
}

#endif

#ifdef HAS_ENVIRONMENT_MAP
const float BY_IMAGE = 0.5; // share of directions

// By one direction, drawn from the image or cosine-weighted, and weighed by the density of both together.
vec3 light_by_image(vec3 point, vec3 normal, vec2 u) {
    EnvironmentHeader sky = load_environment();
    EnvironmentPoint from;
    if (u.x < BY_IMAGE) from = sample_environment(sky, uvec2(vec2(u.x / BY_IMAGE, u.y) * 4294967296.0));
    else from = see_environment(sky, sample_cosine(normal, (u.x - BY_IMAGE) / (1.0 - BY_IMAGE), u.y));
    float cosine = dot(from.direction, normal);
    if (cosine <= 0.0) return vec3(0.0);
    float density = BY_IMAGE * from.largest / sky.whole + (1.0 - BY_IMAGE) * cosine / PI;
    return from.radiance * (cosine / density * pass_straight(Ray(point, from.direction), INFINITY));
}
#endif

#ifdef HAS_ENVIRONMENT
// By one direction, cosine-weighted.
vec3 light_around(Light light, vec3 point, vec3 normal, vec2 u) {
#ifdef HAS_ENVIRONMENT_MAP
    if (light.cone.x > 0.0) return light_by_image(point, normal, u);
#endif
    vec3 direction = sample_cosine(normal, u.x, u.y);
    return PI * light.intensity.rgb * pass_straight(Ray(point, direction), INFINITY);
}
#endif

#if defined(HAS_AREA_LIGHTS) || defined(HAS_ENVIRONMENT)
// Of this sample for a light, in [0, 1)³: a place, and which part of it.
vec3 draw_place(uint slot, uint light) {
    uint at = slot % settings.sample_count;
    uint pixel = settings.first_pixel + at / settings.samples;
    uvec4 scramble = random_words(settings.seed, pixel, 0xfffffffdu, light);
    uint within = at % settings.samples;
    return vec3(to_unit_float(scramble_owen(sobol_bits(within, 0u), scramble.x)),
                to_unit_float(scramble_owen(sobol_bits(within, 1u), scramble.y)),
                to_unit_float(scramble_owen(sobol_bits(within, 2u), scramble.z)));
}
#endif

vec3 light_hit(uint i, vec3 point, vec3 normal, uint slot) {
    Light light = lights[i];
    uint kind = floatBitsToUint(light.position_kind.w);
#ifdef HAS_AREA_LIGHTS
    if (kind == LIGHT_AREA) return light_area(light, point, normal, draw_place(slot, i));
#endif
#ifdef HAS_ENVIRONMENT
    if (kind == LIGHT_ENVIRONMENT) return light_around(light, point, normal, draw_place(slot, i).xy);
#endif
    return light_from(light, point, normal);
}

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= settings.sample_count * settings.slot_count) return;
    vec4 point = hit_point_at(slot);
    vec3 sum = vec3(0.0);
    float bent = hit_weight_at(slot).w; // as a texture turns the normal; 0: it does not
    vec3 normal = bent == 0.0 ? hit_normal_at(slot).xyz : unpack_normal(floatBitsToUint(bent));
    hit_medium = floatBitsToUint(hit_normal_at(slot).w);
    if (point.w > 0.0)
        for (uint i = 0u; i < settings.light_count; ++i) sum += light_hit(i, point.xyz, normal, slot);
    direct_irradiance[slot] = vec4(sum, 0.0);
}
