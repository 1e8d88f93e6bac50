// SPDX-License-Identifier: Apache-2.0
// Splits nodes of few photons, one an invocation: a sorting network finds the median.
// Inputs: source, range_rows, scales. Outputs: target, tree_nodes.
// Defines: SORT_SIZE keys, EACH_KEY(DO) and SORT_NETWORK(DO) as engine/photons/build_tree.cpp writes them, RANGE_ROWS.
#include "shared/prelude.glsl"
#include "photons/tree_source.glsl"
#ifdef RANGE_ROWS
#include "photons/node_spread.glsl"
#endif

#define LOAD_KEY(i) keys[i] = i < n ? find_key(source_at(first + min(i, n - 1u)), axis) : GREATEST_KEY;
#define SORT_KEYS(a, b) { int least = min(keys[a], keys[b]); keys[b] = max(keys[a], keys[b]); keys[a] = least; }
#define COUNT_KEY(i) below += uint(keys[i] < pivot);

uint choose_axis_of(uint heap, uint first, uint n) {
#ifdef RANGE_ROWS
    Spread spread = start_spread();
    vec4 base = source_at(first);
    for (uint i = 0u; i < n; ++i) add_photon(spread, source_at(first + i), base, true);
    float greatest;
    return choose_axis(spread, greatest);
#else
    return find_widest(tree_nodes[heap].hi_axis.xyz - tree_nodes[heap].lo_split.xyz);
#endif
}

// The key of that rank and how many are below it; halves begin at whole tiles.
int find_pivot(uint first, uint n, uint axis, uint rank, out uint below) {
    int keys[SORT_SIZE];
    EACH_KEY(LOAD_KEY)
    SORT_NETWORK(SORT_KEYS)
    int pivot = rank == 8u ? keys[8] : keys[16];
#if SORT_SIZE > 32
    pivot = rank == 24u ? keys[24] : (rank == 32u ? keys[32] : pivot);
#endif
    below = 0u;
    EACH_KEY(COUNT_KEY)
    return pivot;
}

void main() {
    if (gl_GlobalInvocationID.x >= build.count) return;
    uint node = build.first + gl_GlobalInvocationID.x;
    uint heap = (1u << build.level) + node;
    uint first = find_first_position(build.photon_count, node, build.level);
    uint n = find_first_position(build.photon_count, node + 1u, build.level) - first;
    uint right = find_first_position(build.photon_count, 2u * node + 1u, build.level + 1u);
    uint left = first;
    uint axis = choose_axis_of(heap, first, n);
    uint below;
    int pivot = find_pivot(first, n, axis, right - first, below);
    uint ties = right - first - below; // go left
    Halves halves = start_halves();
    for (uint i = 0u; i < n; ++i) {
        vec4 photon = source_at(first + i);
        int key = find_key(photon, axis);
        bool is_tie = key == pivot && ties > 0u;
        bool is_left = key < pivot || is_tie;
        ties -= uint(is_tie);
        target[is_left ? left : right] = photon;
        left += uint(is_left);
        right += uint(!is_left);
        widen(halves.left_lo, halves.left_hi, photon.xyz, is_left);
        widen(halves.right_lo, halves.right_hi, photon.xyz, !is_left);
    }
    write_split(heap, read_key(pivot), axis);
    write_children(heap, halves);
}
