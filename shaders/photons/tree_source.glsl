// SPDX-License-Identifier: Apache-2.0
// What the kernels that split nodes share: a level's photons, read from `source` and written in the order of the next
// level to `target`. Halves keep the order they were in, so within a node photons stand by id and ties go by place.
// Defines: RANGE_ROWS vec4s of ranges a photon, if any.
#include "photons/tree_layout.glsl"
#include "photons/float_keys.glsl"
#pragma binding texel source
#pragma binding texel range_rows
#pragma binding readonly vec4 scales
#pragma binding writeonly vec4 target
#pragma binding coherent TreeNode tree_nodes

layout(push_constant) uniform Push { TreeBuild build; };

float pick_component(vec4 v, uint i) { return i < 2u ? (i == 0u ? v.x : v.y) : (i == 2u ? v.z : v.w); }

#ifdef RANGE_ROWS
vec4 read_row(vec4 photon, uint row) { return range_rows_at(floatBitsToUint(photon.w) * RANGE_ROWS + row); }
#endif

int find_key(vec4 photon, uint axis) {
    float value = pick_component(photon, axis);
#ifdef RANGE_ROWS
    uint range = axis < 3u ? 0u : axis - 3u;
    float other = pick_component(read_row(photon, range / 4u), range % 4u);
    value = axis < 3u ? value : other;
#endif
    return make_key(value);
}

uint find_widest(vec3 extent) {
    return extent.x >= extent.y && extent.x >= extent.z ? 0u : (extent.y >= extent.z ? 1u : 2u);
}

#ifdef RANGE_ROWS
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

// The axis of greatest scaled spread; `greatest` is 0 where none has any.
uint choose_axis(Spread spread, out float greatest) {
    uint best = 0u;
    greatest = 0.0;
    vec3 position = find_spread(spread) * scales[0].xyz * scales[0].xyz;
    prefer(position.x, 0u, greatest, best);
    prefer(position.y, 1u, greatest, best);
    prefer(position.z, 2u, greatest, best);
    for (uint row = 0u; row < RANGE_ROWS; ++row) {
        vec4 range = find_row_spread(spread, row) * scales[1u + row] * scales[1u + row];
        prefer(range.x, 3u + 4u * row, greatest, best);
        prefer(range.y, 4u + 4u * row, greatest, best);
        prefer(range.z, 5u + 4u * row, greatest, best);
        prefer(range.w, 6u + 4u * row, greatest, best);
    }
    return best;
}
#endif

// Boxes of both halves while their photons are written.
struct Halves {
    vec3 left_lo, left_hi, right_lo, right_hi;
};

Halves start_halves() { return Halves(vec3(INFINITY), vec3(-INFINITY), vec3(INFINITY), vec3(-INFINITY)); }

void widen(inout vec3 lo, inout vec3 hi, vec3 p, bool counts) {
    lo = vec3(counts && p.x < lo.x ? p.x : lo.x, counts && p.y < lo.y ? p.y : lo.y, counts && p.z < lo.z ? p.z : lo.z);
    hi = vec3(counts && p.x > hi.x ? p.x : hi.x, counts && p.y > hi.y ? p.y : hi.y, counts && p.z > hi.z ? p.z : hi.z);
}

void write_split(uint heap, float value, uint axis) {
    tree_nodes[heap].lo_split.w = value;
    tree_nodes[heap].hi_axis.w = uintBitsToFloat(axis);
}

void write_children(uint heap, Halves halves) {
    float leaf = uintBitsToFloat(TREE_LEAF);
    tree_nodes[2u * heap] = TreeNode(vec4(halves.left_lo, 0.0), vec4(halves.left_hi, leaf));
    tree_nodes[2u * heap + 1u] = TreeNode(vec4(halves.right_lo, 0.0), vec4(halves.right_hi, leaf));
}
