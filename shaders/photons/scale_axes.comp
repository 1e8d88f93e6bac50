// SPDX-License-Identifier: Apache-2.0
// How much the spread along each axis counts when a tree with ranges is split; one subgroup, from evenly spaced photons.
// Inputs: source, range_rows. Output: axis_scales (vec4 of the positions', then a vec4 a row).
// Defines: RANGE_ROWS, RANGE_AXES, SPLIT_POSITIONS where nodes are split along positions too.
#include "shared/prelude.glsl"
#include "photons/tree_source.glsl"
#include "photons/select_key.glsl"
#include "photons/choose_axis.glsl"
#pragma binding writeonly vec4 axis_scales

const uint LARGEST_SAMPLE = 4096u;

float scale_to(float wanted, float variance) { return variance > 0.0 ? sqrt(wanted / variance) : 0.0; }

void main() {
    uint n = build.photon_count;
    uint samples = min(n, LARGEST_SAMPLE);
    Spread spread = start_spread();
    vec4 base = source_at(0u);
    for (uint i = LANE; i < samples; i += WIDTH)
        add_photon(spread, source_at(n / samples * i + n % samples * i / samples), base, true);
    spread = join_spread(spread);
    vec3 position = find_spread(spread);
    float wanted = max(position.x, max(position.y, position.z));
    float greatest = 0.0; // of the parameters
    for (uint axis = 1u; axis < RANGE_AXES; ++axis)
        greatest = max(greatest, find_row_spread(spread, axis / 4u)[axis % 4u]);
#ifdef SPLIT_POSITIONS
    if (LANE == 0u) axis_scales[0] = vec4(1.0, 1.0, 1.0, 0.0);
    // Where all photons are in one place the parameters decide alone.
    wanted = wanted > 0.0 ? wanted : 1.0;
#else
    if (LANE == 0u) axis_scales[0] = vec4(0.0);
    wanted = greatest > 0.0 ? greatest : 1.0; // a layer number alone
#endif
    for (uint row = 0u; row < RANGE_ROWS; ++row) {
        vec4 variance = find_row_spread(spread, row);
        vec4 scale = vec4(0.0);
        for (uint i = 0u; i < 4u; ++i) {
            uint axis = 4u * row + i;
            scale[i] = scale_to(wanted, variance[i]);
#ifndef SPLIT_POSITIONS
            if (axis > 0u && axis < RANGE_AXES) scale[i] = 1.0;
#else
            if (axis > 0u && axis < RANGE_AXES && build.parameter_scale > 0.0) scale[i] = build.parameter_scale;
#endif
        }
        if (LANE == 0u) axis_scales[1u + row] = scale;
    }
}
