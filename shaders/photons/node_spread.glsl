// SPDX-License-Identifier: Apache-2.0
// How far the photons of a node are spread along positions and ranges, and along which axis it is split therefore.
// Needs photons/tree_source.glsl and RANGE_ROWS.

// How far the photons of a node are spread along each axis: sums of differences from its first photon.
struct Spread {
    float count;
    vec3 sum, squares;
    vec4 row_sums[RANGE_ROWS], row_squares[RANGE_ROWS];
};

Spread start_spread() {
    Spread spread;
    spread.count = 0.0;
    spread.sum = spread.squares = vec3(0.0);
    for (uint row = 0u; row < RANGE_ROWS; ++row) spread.row_sums[row] = spread.row_squares[row] = vec4(0.0);
    return spread;
}

void add_photon(inout Spread spread, vec4 photon, vec4 base, bool counts) {
    vec3 offset = counts ? photon.xyz - base.xyz : vec3(0.0);
    spread.count += counts ? 1.0 : 0.0;
    spread.sum += offset;
    spread.squares += offset * offset;
    for (uint row = 0u; row < RANGE_ROWS; ++row) {
        vec4 difference = counts ? read_row(photon, row) - read_row(base, row) : vec4(0.0);
        spread.row_sums[row] += difference;
        spread.row_squares[row] += difference * difference;
    }
}

// Squares of spreads, positions first, then each row.
vec3 find_spread(Spread spread) {
    return max(spread.squares / spread.count - spread.sum * spread.sum / (spread.count * spread.count), vec3(0.0));
}

vec4 find_row_spread(Spread spread, uint row) {
    vec4 mean = spread.row_sums[row] / spread.count;
    return max(spread.row_squares[row] / spread.count - mean * mean, vec4(0.0));
}

void prefer(float value, uint axis, inout float greatest, inout uint best) {
    best = value > greatest ? axis : best;
    greatest = max(greatest, value);
}

// The axis of greatest scaled spread; where none has any `greatest` is 0, and along that of the layer number all tie.
uint choose_axis(Spread spread, out float greatest) {
    uint best = 3u;
    greatest = 0.0;
    vec3 position = find_spread(spread) * scales_at(0u).xyz * scales_at(0u).xyz;
    prefer(position.x, 0u, greatest, best);
    prefer(position.y, 1u, greatest, best);
    prefer(position.z, 2u, greatest, best);
    for (uint row = 0u; row < RANGE_ROWS; ++row) {
        vec4 range = find_row_spread(spread, row) * scales_at(1u + row) * scales_at(1u + row);
        prefer(range.x, 3u + 4u * row, greatest, best);
        prefer(range.y, 4u + 4u * row, greatest, best);
        prefer(range.z, 5u + 4u * row, greatest, best);
        prefer(range.w, 6u + 4u * row, greatest, best);
    }
    return best;
}
