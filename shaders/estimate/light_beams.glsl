// SPDX-License-Identifier: Apache-2.0
// Lights that reach a point from one direction: point, spot and directional ones.
// Inputs: lights. Defines: HAS_SPOT_LIGHTS, HAS_DIRECTIONAL_LIGHTS, HAS_AREA_LIGHTS, HAS_ENVIRONMENT.
#pragma binding readonly Light lights

// What of a light comes to a point.
struct Beam {
    vec3 direction;  // unit, towards the light
    float distance;  // metres; INFINITY: a directional light
    vec3 irradiance; // W/m² on a surface across it
};

// Unit direction and distance to a point; false where they are one.
bool aim_at(vec3 to_light, out vec3 direction, out float distance) {
    float largest = max(abs(to_light.x), max(abs(to_light.y), abs(to_light.z)));
    direction = normalize_safely(to_light);
    distance = largest * sqrt(dot(to_light / largest, to_light / largest));
    return largest > 0.0;
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

// False for lights that reach a point from many directions, and where nothing arrives.
bool find_beam(Light light, vec3 point, out Beam beam) {
    beam = Beam(-light.direction.xyz, INFINITY, light.intensity.rgb);
    uint kind = floatBitsToUint(light.position_kind.w);
#ifdef HAS_DIRECTIONAL_LIGHTS
    if (kind == LIGHT_DIRECTIONAL) return true;
#endif
#if defined(HAS_AREA_LIGHTS) || defined(HAS_ENVIRONMENT)
    if (kind == LIGHT_AREA || kind == LIGHT_ENVIRONMENT) return false;
#endif
    if (!aim_at(light.position_kind.xyz - point, beam.direction, beam.distance)) return false;
    float share = 1.0;
#ifdef HAS_SPOT_LIGHTS
    share = attenuate_spot(light, beam.direction);
#endif
    beam.irradiance *= share / beam.distance / beam.distance;
    return share > 0.0;
}
