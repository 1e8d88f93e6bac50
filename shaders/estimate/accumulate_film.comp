// SPDX-License-Identifier: Apache-2.0
// Averages the samples of each pixel (box filter): emission seen, direct light and the photon map's irradiance.
// Inputs: hit_weight, direct_irradiance, map_irradiance, eye_emission; with the define HAS_MEDIA beam_weight,
// beam_radiance: what photons in media send. Output: film (rgb radiance, W/(m² sr)).
#include "shared/prelude.glsl"
#include "shared/render.h"
#include "estimate/luminance.glsl"
#pragma binding texel hit_weight
#pragma binding texel direct_irradiance
#pragma binding texel map_irradiance
#pragma binding texel eye_emission
#ifdef HAS_MEDIA
#pragma binding texel beam_weight
#pragma binding texel beam_radiance
#endif
#pragma binding writeonly vec4 film

layout(push_constant) uniform Push { FilmSettings settings; };

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= settings.pixel_count) return;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < settings.samples; ++i) {
        uint index = pixel * settings.samples + i;
        if (settings.uses_emission != 0u) sum += eye_emission_at(index).rgb;
#ifdef HAS_MEDIA
        for (uint beam = 0u; beam < settings.beam_count; ++beam) {
            uint at = beam * settings.sample_count + index;
            vec3 radiance = beam_radiance_at(at).rgb;
            if (radiance != vec3(0.0)) sum += beam_weight_at(at).rgb * radiance;
        }
#endif
        for (uint slot = 0u; slot < settings.slot_count; ++slot) {
            uint at = slot * settings.sample_count + index;
            vec3 weight = hit_weight_at(at).rgb;
            if (settings.uses_colors != 0u) weight = vec3(find_luminance(weight));
            if (settings.uses_direct != 0u) sum += weight * direct_irradiance_at(at).rgb;
            if (settings.uses_map != 0u) sum += weight * map_irradiance_at(at).rgb;
        }
    }
    film[settings.first_pixel + pixel] = vec4(sum / float(settings.samples), 1.0);
}
