// SPDX-License-Identifier: Apache-2.0
// What the kernels that split nodes share: a level's photons, read from `source` and written in the order of the next
// level to `target`. Halves keep the order they were in, so within a node photons stand by id and ties go by place.
// Defines: RANGE_ROWS vec4s of ranges a photon, if any.
#include "photons/tree_layout.glsl"
#include "photons/float_keys.glsl"
#pragma binding texel source
#pragma binding texel range_rows
#pragma binding texel scales
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
