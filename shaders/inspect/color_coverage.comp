// SPDX-License-Identifier: Apache-2.0
// Colors the counts of curves on a logarithmic scale: the selection through a color map, over the context in one color.
// Inputs: coverage, largest, color_map (256 sRGB colors). Output: pixels.
#include "shared/prelude.glsl"
#include "shared/parallel.h"
#include "inspect/pack_color.glsl"
#pragma binding readonly uvec2 coverage
#pragma binding readonly uint largest
#pragma binding texel color_map
#pragma binding writeonly uint pixels

layout(push_constant) uniform Push { PixelSettings settings; };

const uint COLOR_COUNT = 256u;
// Of the densest context's opacity: what a single curve keeps, so that it is still seen.
const float LEAST_SHARE = 0.25;

// 0 for one curve, 1 for as many as the densest pixel has.
float scale_count(uint count, uint most) { return most > 1u ? log2(float(count)) / log2(float(most)) : 0.0; }

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= settings.pixel_count) return;
    uvec2 counts = coverage[pixel];
    vec4 color = settings.background;
    if (counts.x > 0u) {
        float opacity = settings.context.a * mix(LEAST_SHARE, 1.0, scale_count(counts.x, largest[0]));
        color = vec4(settings.context.rgb * opacity, opacity) + color * (1.0 - opacity);
    }
    if (counts.y > 0u) {
        uint entry = uint(scale_count(counts.y, largest[1]) * float(COLOR_COUNT));
        color = vec4(color_map_at(min(entry, COLOR_COUNT - 1u)).rgb, 1.0);
    }
    pixels[pixel] = pack_color(color);
}
