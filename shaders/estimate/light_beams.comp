// SPDX-License-Identifier: Apache-2.0
// Radiance that lights send straight into stretches of eye paths in media and that is scattered once, towards the eye
// (METHODS §13). Some points of each stretch are lit, drawn where the light is near (equiangular: Kulla and Fajardo 2012)
// or where the eye sees far enough.
// Inputs: scene, lights, emitting, environment_map, beam_origin, beam_direction. In and out: beam_radiance.
// Defines: HAS_MEDIA and those of light_direct.comp.
#include "shared/prelude.glsl"
#include "shared/random.h"
#include "shared/render.h"
#include "scene/scatter.glsl"
#ifdef HAS_AREA_LIGHTS
#include "scene/emitting.glsl"
#endif
#ifdef HAS_ENVIRONMENT_MAP
#include "scene/environment.glsl"
#endif
#include "estimate/light_beams.glsl"
#pragma binding texel beam_origin
#pragma binding texel beam_direction
#pragma binding vec4 beam_radiance

layout(push_constant) uniform Push { FilmSettings settings; };

// Points of a stretch that are lit by each light.
const uint LIT_POINTS = 4u;
// A ray to an area light is stopped short of it by this share of its length.
const float BEFORE_LAMP = 0.9999;
// A light on the ray itself counts as this share of the stretch beside it.
const float LEAST_DISTANCE = 1e-6;

struct EyeBeam {
    vec3 origin, direction;
    float end; // metres
    uint boundary;
    Medium medium;
};

// A place along the stretch, and the reciprocal of its density.
struct LitPoint {
    float along, spread;
};

float find_angle(float x, float d) { return 0.5 * PI - acos_exact(clamp(x / sqrt(x * x + d * d), -1.0, 1.0)); }

// Even in the angle under which a place is seen from the light.
LitPoint draw_near(EyeBeam beam, vec3 light, float u) {
    vec3 offset = light - beam.origin;
    float foot = dot(offset, beam.direction);
    vec3 aside = offset - foot * beam.direction;
    float d = max(sqrt(dot(aside, aside)), LEAST_DISTANCE * beam.end);
    float first = find_angle(-foot, d), last = find_angle(beam.end - foot, d);
    float s, c;
    sin_cos(mix(first, last, u), s, c);
    float x = d * s / max(c, 1e-7);
    return LitPoint(clamp(foot + x, 0.0, beam.end), (last - first) * (d * d + x * x) / d);
}

// As light that comes back along the stretch is weakened, in the mean of the channels.
LitPoint draw_far(EyeBeam beam, float u) {
    float extinction = dot(beam.medium.extinction, vec3(1.0 / 3.0));
    float stopped = 1.0 - exp_exact(-extinction * beam.end);
    if (!(stopped > 1e-4)) return LitPoint(u * beam.end, beam.end); // thin: evenly
    float along = min(-log_exact(max(1.0 - u * stopped, 1e-30)) / extinction, beam.end);
    return LitPoint(along, stopped / (extinction * exp_exact(-extinction * along)));
}

// Of light of that irradiance across its way, from `towards`.
vec3 scatter_to_eye(EyeBeam beam, LitPoint at, vec3 towards, float distance, vec3 irradiance) {
    vec3 point = beam.origin + at.along * beam.direction;
    vec3 arriving = irradiance * pass_media(Ray(point, towards), distance, Media(beam.boundary, 0u), true);
    float phase = find_phase(beam.medium.anisotropy, dot(towards, beam.direction));
    return beam.medium.extinction * beam.medium.albedo * transmit(beam.medium.extinction, at.along) * arriving * (phase * at.spread);
}

vec3 light_point(Light light, EyeBeam beam, vec4 u) {
    uint kind = floatBitsToUint(light.position_kind.w);
#ifdef HAS_AREA_LIGHTS
    if (kind == LIGHT_AREA) {
        EmittingPoint from = sample_emitting(floatBitsToUint(light.cone.y), floatBitsToUint(light.cone.z), u.w, u.yz);
        LitPoint at = draw_near(beam, from.position, u.x);
        vec3 direction;
        float distance;
        if (!aim_at(from.position - beam.origin - at.along * beam.direction, direction, distance)) return vec3(0.0);
        float leaving = -dot(direction, from.normal);
        if (light.cone.w > 1.0) leaving = abs(leaving);
        vec3 irradiance = light.intensity.rgb * from.tint * (light.cone.x * max(leaving, 0.0) / distance / distance);
        return scatter_to_eye(beam, at, direction, distance * BEFORE_LAMP, irradiance);
    }
#endif
#ifdef HAS_ENVIRONMENT
    if (kind == LIGHT_ENVIRONMENT) { // drawn from the phase function, which cancels
        vec3 direction = sample_phase(beam.medium.anisotropy, beam.direction, uint(u.y * 4294967040.0), uint(u.z * 4294967040.0));
        vec3 radiance = light.intensity.rgb;
#ifdef HAS_ENVIRONMENT_MAP
        if (light.cone.x > 0.0) radiance = see_environment(load_environment(), direction).radiance;
#endif
        float phase = find_phase(beam.medium.anisotropy, dot(direction, beam.direction));
        return scatter_to_eye(beam, draw_far(beam, u.x), direction, INFINITY, radiance / phase);
    }
#endif
    bool is_near = kind != LIGHT_DIRECTIONAL;
    LitPoint at = is_near ? draw_near(beam, light.position_kind.xyz, u.x) : draw_far(beam, u.x);
    Beam from;
    if (!find_beam(light, beam.origin + at.along * beam.direction, from)) return vec3(0.0);
    return scatter_to_eye(beam, at, from.direction, from.distance, from.irradiance);
}

// In [0, 1)⁴: the points of all samples of a pixel are spread together.
vec4 draw_numbers(uint at, uint light, uint turn) {
    uint within = at % settings.sample_count;
    uint pixel = settings.first_pixel + within / settings.samples;
    uvec4 scramble = random_words(settings.seed, pixel, 0xfffffffbu, light * settings.beam_count + at / settings.sample_count);
    uint index = (within % settings.samples) * LIT_POINTS + turn;
    return vec4(to_unit_float(scramble_owen(sobol_bits(index, 0u), scramble.x)),
                to_unit_float(scramble_owen(sobol_bits(index, 1u), scramble.y)),
                to_unit_float(scramble_owen(sobol_bits(index, 2u), scramble.z)),
                to_unit_float(scramble_owen(sobol_bits(index, 3u), scramble.w)));
}

void main() {
    uint at = gl_GlobalInvocationID.x;
    if (at >= settings.sample_count * settings.beam_count) return;
    vec4 origin = beam_origin_at(at), direction = beam_direction_at(at);
    if (!(origin.w > 0.0)) return;
    uint boundary = floatBitsToUint(direction.w);
    EyeBeam beam = EyeBeam(origin.xyz, direction.xyz, origin.w, boundary, load_medium(boundary));
    vec3 sum = vec3(0.0);
    for (uint light = 0u; light < settings.light_count; ++light)
        for (uint turn = 0u; turn < LIT_POINTS; ++turn) {
            ++turns;
            sum += light_point(lights[light], beam, draw_numbers(at, light, turn));
        }
    beam_radiance[at] = vec4(beam_radiance[at].rgb + sum / float(LIT_POINTS), 0.0);
}
