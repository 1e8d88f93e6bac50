// SPDX-License-Identifier: Apache-2.0
// Along which axis a subgroup splits a node: the widest, or with ranges the one of greatest spread among some photons.
// Needs photons/select_key.glsl. Define: RANGE_ROWS.
#ifdef RANGE_ROWS
#include "photons/node_spread.glsl"

const uint SPREAD_SAMPLES = 64u;

Spread join_spread(Spread spread) {
    spread.count = sum_lanes(spread.count);
    for (uint i = 0u; i < 3u; ++i) {
        spread.sum[i] = sum_lanes(spread.sum[i]);
        spread.squares[i] = sum_lanes(spread.squares[i]);
    }
    for (uint row = 0u; row < RANGE_ROWS; ++row) {
        spread.row_sums[row] = sum_lanes(spread.row_sums[row]);
        spread.row_squares[row] = sum_lanes(spread.row_squares[row]);
    }
    return spread;
}

// The axis of greatest spread among evenly spaced photons of the n at `first`; among all where those are alike.
uint choose_sampled_axis(uint first, uint n) {
    vec4 base = source_at(first);
    Spread spread = start_spread();
    for (uint s = LANE; s < SPREAD_SAMPLES; s += WIDTH)
        add_photon(spread, source_at(first + find_spaced(n, s, SPREAD_SAMPLES)), base, true);
    float greatest;
    uint axis = choose_axis(join_spread(spread), greatest);
    uint rest = greatest > 0.0 ? 0u : n;
    vec3 lo = vec3(0.0), hi = vec3(0.0);
    vec4 row_lo[RANGE_ROWS], row_hi[RANGE_ROWS];
    for (uint row = 0u; row < RANGE_ROWS; ++row) row_lo[row] = row_hi[row] = vec4(0.0);
    for (uint i = LANE; i < rest; i += WIDTH) {
        vec4 photon = source_at(first + i);
        lo = min(lo, photon.xyz - base.xyz);
        hi = max(hi, photon.xyz - base.xyz);
        for (uint row = 0u; row < RANGE_ROWS; ++row) {
            vec4 difference = read_row(photon, row) - read_row(base, row);
            row_lo[row] = min(row_lo[row], difference);
            row_hi[row] = max(row_hi[row], difference);
        }
    }
    vec3 extent = (join_greatest(hi) - join_least(lo)) * scales_at(0u).xyz;
    prefer(extent.x, 0u, greatest, axis);
    prefer(extent.y, 1u, greatest, axis);
    prefer(extent.z, 2u, greatest, axis);
    for (uint row = 0u; row < RANGE_ROWS; ++row)
        for (uint i = 0u; i < 4u; ++i) {
            float scaled = (find_most(row_hi[row][i]) - find_least(row_lo[row][i])) * scales_at(1u + row)[i];
            prefer(scaled, 3u + 4u * row + i, greatest, axis);
        }
    return axis;
}
#endif

uint choose_axis_of(uint heap, uint first, uint n) {
#ifdef RANGE_ROWS
    return choose_sampled_axis(first, n);
#else
    return find_widest(tree_nodes[heap].hi_axis.xyz - tree_nodes[heap].lo_split.xyz);
#endif
}
