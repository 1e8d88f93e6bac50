// SPDX-License-Identifier: Apache-2.0
// Irradiance that point lights send straight to each eye hit; every surface, glass too, blocks it (METHODS §0).
// Inputs: scene, lights, hit_point, hit_normal. Output: direct_irradiance.
#include "shared/prelude.glsl"
#include "shared/render.h"
#include "shared/math.glsl"
#include "scene/intersect.glsl"
#pragma binding readonly Light lights
#pragma binding texel hit_point
#pragma binding texel hit_normal
#pragma binding writeonly vec4 direct_irradiance

layout(push_constant) uniform Push { FilmSettings settings; };

vec3 light_point(Light light, vec3 point, vec3 normal) {
    vec3 to_light = light.position_kind.xyz - point;
    float largest = max(abs(to_light.x), max(abs(to_light.y), abs(to_light.z)));
    if (!(largest > 0.0)) return vec3(0.0);
    vec3 direction = normalize_safely(to_light);
    float cosine = dot(direction, normal);
    if (cosine <= 0.0) return vec3(0.0);
    float distance = largest * sqrt(dot(to_light / largest, to_light / largest));
    if (intersect_scene(Ray(point, direction), distance, true).t < distance) return vec3(0.0);
    return light.intensity.rgb / distance / distance * cosine;
}

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= settings.sample_count * settings.slot_count) return;
    vec4 point = hit_point_at(slot);
    vec3 sum = vec3(0.0);
    if (point.w > 0.0)
        for (uint i = 0u; i < settings.light_count; ++i) sum += light_point(lights[i], point.xyz, hit_normal_at(slot).xyz);
    direct_irradiance[slot] = vec4(sum, 0.0);
}
