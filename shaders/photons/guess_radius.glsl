// SPDX-License-Identifier: Apache-2.0
// A first guess at the radius of a rank, from the leaf where a query lies: any guess gives the same radius, a good one
// sooner. The kernel includes photons/candidates.glsl first.

// Shares of a box's longest side below which it counts as a line.
const float LINE_SHARE = 0.02;

// The two longest sides of a leaf, in the space of the measure.
vec2 find_longest_sides(uint node) {
    vec2 longest = vec2(0.0);
#define COMPARE_SIDE(side) { float s = side; longest.y = max(longest.y, min(longest.x, s)); longest.x = max(longest.x, s); }
#ifdef IN_PARAMETER_SPACE
#define COMPARE_AXIS(a) COMPARE_SIDE(tree_ranges_at(2u * ROW_COUNT * node + ROW_COUNT + uint(a / 4))[a % 4] - \
                                     tree_ranges_at(2u * ROW_COUNT * node + uint(a / 4))[a % 4])
    EACH_PARAMETER(COMPARE_AXIS)
#else
    Place extent = take_place(tree_nodes_at(2u * node + 1u)) - take_place(tree_nodes_at(2u * node));
#define COMPARE_EXTENT(a) COMPARE_SIDE(extent.a)
    EACH_AXIS(COMPARE_EXTENT)
#endif
    return longest;
}

// Squared radius of a rank if a leaf's photons lie evenly over its box or along it.
float guess_in_leaf(uint photon_count, uint leaf_level, uint leaf, uint rank) {
    uint photons = find_first_position(photon_count, leaf + 1u, leaf_level) -
                   find_first_position(photon_count, leaf, leaf_level);
    vec2 sides = find_longest_sides((1u << leaf_level) + leaf);
    float each = float(max(rank, 2u) - 1u) / float(photons);
    float along = 0.5 * sides.x * each;
    return sides.y > LINE_SHARE * sides.x ? sides.x * sides.y * each / PI : along * along;
}

#ifdef OWN_PHOTONS
float guess_radius2(GatherSettings gather, uint query, out float nearest2) {
    nearest2 = 0.0;
    float share = float(query) / float(gather.photon_count); // exact enough for a guess
    uint leaf_count = 1u << gather.leaf_level;
    uint leaf = min(uint(share * float(leaf_count)), leaf_count - 1u);
    return guess_in_leaf(gather.photon_count, gather.leaf_level, leaf, gather.rank);
}
#else
// Walks down to a near leaf.
float guess_radius2(GatherSettings gather, uint query, out float nearest2) {
    Query own = get_query();
    uint node = 1u;
    float bound = 0.0;
    for (uint level = 0u; level < gather.leaf_level; ++level) {
        float left = bound_measure(own, load_node(2u * node));
        float right = bound_measure(own, load_node(2u * node + 1u));
        node = 2u * node + uint(right < left);
        bound = min(left, right);
    }
    turns += gather.leaf_level;
    float within = guess_in_leaf(gather.photon_count, gather.leaf_level, node - (1u << gather.leaf_level), gather.rank);
    nearest2 = bound < INFINITY ? bound : 0.0;
    return nearest2 + within;
}
#endif
