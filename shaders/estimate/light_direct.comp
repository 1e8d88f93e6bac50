// SPDX-License-Identifier: Apache-2.0
// Irradiance that lights send straight to each eye hit; every surface, glass too, blocks it (METHODS §0). Area lights by
// one point of theirs for each sample of a pixel, spread over their area by the Sobol sequence.
// Inputs: scene, lights, emitting, environment_map, hit_point, hit_normal. Output: direct_irradiance.
// Defines: HAS_SPOT_LIGHTS, HAS_DIRECTIONAL_LIGHTS, HAS_AREA_LIGHTS, HAS_ENVIRONMENT, HAS_ENVIRONMENT_MAP.
#include "shared/prelude.glsl"
#include "shared/random.h"
#include "shared/render.h"
#include "shared/math.glsl"
#include "scene/intersect.glsl"
#ifdef HAS_AREA_LIGHTS
#include "scene/emitting.glsl"
#endif
#ifdef HAS_ENVIRONMENT_MAP
#include "scene/environment.glsl"
#endif
#pragma binding readonly Light lights
#pragma binding texel hit_point
#pragma binding texel hit_normal
#pragma binding writeonly vec4 direct_irradiance

layout(push_constant) uniform Push { FilmSettings settings; };

// A ray to an area light is stopped short of it by this share of its length.
const float BEFORE_LIGHT = 0.9999;

// Unit direction and distance to a point; false where they are one.
bool aim_at(vec3 to_light, out vec3 direction, out float distance) {
    float largest = max(abs(to_light.x), max(abs(to_light.y), abs(to_light.z)));
    direction = normalize_safely(to_light);
    distance = largest * sqrt(dot(to_light / largest, to_light / largest));
    return largest > 0.0;
}

bool is_blocked(vec3 point, vec3 direction, float distance) {
    return intersect_scene(Ray(point, direction), distance, true).t < distance;
}

#ifdef HAS_SPOT_LIGHTS
// KHR_lights_punctual: the square of a ramp in the cosine.
float attenuate_spot(Light light, vec3 direction) {
    if (floatBitsToUint(light.position_kind.w) != LIGHT_SPOT) return 1.0;
    vec3 off = direction + light.direction.xyz; // towards the light against where it shines
    float beyond = 0.5 * dot(off, off);         // 1 - cos, which keeps the digits of narrow cones
    if (beyond <= light.cone.x) return 1.0;
    float ramp = clamp((light.cone.y - beyond) / max(light.cone.y - light.cone.x, 1e-30), 0.0, 1.0);
    return ramp * ramp;
}
#endif

vec3 light_point(Light light, vec3 point, vec3 normal) {
    vec3 direction;
    float distance;
    if (!aim_at(light.position_kind.xyz - point, direction, distance)) return vec3(0.0);
    float cosine = dot(direction, normal);
    if (cosine <= 0.0) return vec3(0.0);
    float share = 1.0;
#ifdef HAS_SPOT_LIGHTS
    share = attenuate_spot(light, direction);
    if (share <= 0.0) return vec3(0.0);
#endif
    if (is_blocked(point, direction, distance)) return vec3(0.0);
    return light.intensity.rgb * share / distance / distance * cosine;
}

#ifdef HAS_DIRECTIONAL_LIGHTS
vec3 light_directional(Light light, vec3 point, vec3 normal) {
    float cosine = -dot(light.direction.xyz, normal);
    if (cosine <= 0.0 || intersect_scene(Ray(point, -light.direction.xyz), INFINITY, true).t < INFINITY) return vec3(0.0);
    return light.intensity.rgb * cosine;
}
#endif

#ifdef HAS_AREA_LIGHTS
vec3 light_area(Light light, vec3 point, vec3 normal, vec3 u) {
    EmittingPoint from = sample_emitting(floatBitsToUint(light.cone.y), floatBitsToUint(light.cone.z), u.z, u.xy);
    vec3 direction;
    float distance;
    if (!aim_at(from.position - point, direction, distance)) return vec3(0.0);
    float cosine = dot(direction, normal);
    float leaving = -dot(direction, from.normal);
    if (light.cone.w > 1.0) leaving = abs(leaving);
    if (cosine <= 0.0 || leaving <= 0.0 || is_blocked(point, direction, distance * BEFORE_LIGHT)) return vec3(0.0);
    return light.intensity.rgb * (light.cone.x * leaving / distance / distance) * cosine;
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
    if (cosine <= 0.0 || intersect_scene(Ray(point, from.direction), INFINITY, true).t < INFINITY) return vec3(0.0);
    float density = BY_IMAGE * from.largest / sky.whole + (1.0 - BY_IMAGE) * cosine / PI;
    return from.radiance * (cosine / density);
}
#endif

#ifdef HAS_ENVIRONMENT
// By one direction, cosine-weighted.
vec3 light_around(Light light, vec3 point, vec3 normal, vec2 u) {
#ifdef HAS_ENVIRONMENT_MAP
    if (light.cone.x > 0.0) return light_by_image(point, normal, u);
#endif
    vec3 direction = sample_cosine(normal, u.x, u.y);
    return intersect_scene(Ray(point, direction), INFINITY, true).t < INFINITY ? vec3(0.0) : PI * light.intensity.rgb;
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
#ifdef HAS_DIRECTIONAL_LIGHTS
    if (kind == LIGHT_DIRECTIONAL) return light_directional(light, point, normal);
#endif
#ifdef HAS_AREA_LIGHTS
    if (kind == LIGHT_AREA) return light_area(light, point, normal, draw_place(slot, i));
#endif
#ifdef HAS_ENVIRONMENT
    if (kind == LIGHT_ENVIRONMENT) return light_around(light, point, normal, draw_place(slot, i).xy);
#endif
    return light_point(light, point, normal);
}

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= settings.sample_count * settings.slot_count) return;
    vec4 point = hit_point_at(slot);
    vec3 sum = vec3(0.0);
    if (point.w > 0.0)
        for (uint i = 0u; i < settings.light_count; ++i) sum += light_hit(i, point.xyz, hit_normal_at(slot).xyz, slot);
    direct_irradiance[slot] = vec4(sum, 0.0);
}
