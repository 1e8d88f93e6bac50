// SPDX-License-Identifier: Apache-2.0
// Draws curves one over the other in the order given, anti-aliased: an invocation owns a column of pixels and walks
// the curves. Within the column a curve is taken as a straight strip, of which each pixel gets the exact area.
// Inputs: column_gaps (first column of up to two gaps, the gaps), curves, extents, colors (sRGB and opacity, by curve).
// Outputs: canvas between dispatches (packed rows), pixels after the last.
#include "shared/prelude.glsl"
#include "shared/parallel.h"
#include "inspect/pack_color.glsl"
#pragma binding readonly uvec4 column_gaps
#pragma binding texel curves
#pragma binding texel extents
#pragma binding texel colors
#pragma binding uvec2 canvas
#pragma binding writeonly uint pixels

layout(push_constant) uniform Push { BlendSettings settings; };

// Below this rise over the column a strip counts as level: the difference of two areas would lose all its digits.
const float LEVEL = 1e-3;

// 16 bits a channel: memory instructions cost more than packing.
uvec2 rows[LARGEST_BAND];

uvec2 pack_row(vec4 color) {
    uvec4 units = uvec4(color * 65535.0 + 0.5);
    return units.xy | units.zw << 16;
}

vec4 unpack_row(uvec2 row) { return vec4(row & 0xffffu, row >> 16) * (1.0 / 65535.0); }

float find_height(vec4 c, float u) {
    return ((c.x * u + c.y) * u + c.z) * u + c.w - 1.0 - float(settings.first_row);
}

// Integral of clamp(v, 0, thickness) from 0 to v.
float integrate_ramp(float v, float thickness) {
    float inside = clamp(v, 0.0, thickness);
    return 0.5 * inside * inside + max(v - thickness, 0.0) * thickness;
}

// Area above height v of a strip that starts at 0, is `thickness` high and falls by `slope` over a column of width 1.
float find_area_above(float v, float thickness, float slope) {
    if (slope < LEVEL) return clamp(v - 0.5 * slope, 0.0, thickness);
    return (integrate_ramp(v, thickness) - integrate_ramp(v - slope, thickness)) / slope;
}

void blend_strip(float left, float right, float width, vec4 color) {
    float slope = abs(right - left) / width;
    float thickness = settings.line_width * sqrt(1.0 + slope * slope);
    float top = min(left, right) - 0.5 * thickness;
    float bottom = max(left, right) + 0.5 * thickness;
    int first = int(clamp(floor(top), 0.0, float(settings.row_count)));
    int last = int(clamp(floor(bottom), -1.0, float(settings.row_count - 1u)));
    float above = find_area_above(float(first) - top, thickness, slope * width);
    for (int row = first; row <= last; ++row) {
        float next = find_area_above(float(row + 1) - top, thickness, slope * width);
        float opacity = color.a * width * clamp(next - above, 0.0, 1.0);
        rows[row] = pack_row(vec4(color.rgb * opacity, opacity) + unpack_row(rows[row]) * (1.0 - opacity));
        above = next;
    }
}

void draw_gap(uint column, uint first_column, uint gap, uint curve, vec4 color) {
    uint at = gap * settings.curve_count + curve;
    vec2 extent = extents_at(at).xy;
    float u = float(column - first_column);
    float from = max(u, extent.x);
    float to = min(u + 1.0, extent.y);
    if (!(to > from)) return;
    vec4 c = curves_at(at);
    blend_strip(find_height(c, from), find_height(c, to), to - from, color);
}

void load_rows(uint at) {
    uvec2 background = pack_row(clamp(settings.background, 0.0, 1.0));
    for (uint row = 0u; row < settings.row_count; ++row)
        rows[row] = settings.first_curve == 0u ? background : canvas[at + row * settings.width];
}

void store_rows(uint at) {
    for (uint row = 0u; row < settings.row_count; ++row)
        if (settings.end_curve == settings.curve_count)
            pixels[at + row * settings.width] = pack_color(unpack_row(rows[row]));
        else
            canvas[at + row * settings.width] = rows[row];
}

void main() {
    uint column = gl_GlobalInvocationID.x;
    if (column >= settings.width) return;
    uvec4 gaps = column_gaps[column];
    uint at = settings.first_row * settings.width + column;
    load_rows(at);
    for (uint curve = settings.first_curve; curve < settings.end_curve; ++curve) {
        if (gaps.y < settings.gap_count) draw_gap(column, gaps.x, gaps.y, curve, colors_at(curve));
        if (gaps.w < settings.gap_count) draw_gap(column, gaps.z, gaps.w, curve, colors_at(curve));
    }
    store_rows(at);
}
