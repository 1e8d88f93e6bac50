// SPDX-License-Identifier: Apache-2.0
// Boxes of the tree's leaves about where their photons are now. In: tree_positions. Out: tree_nodes (leaves).
#include "shared/prelude.glsl"
#include "photons/tree_layout.glsl"
#pragma binding texel tree_positions
#pragma binding writeonly TreeNode tree_nodes

layout(push_constant) uniform Push { TreeRefit refit; };

void main() {
    if (gl_GlobalInvocationID.x >= refit.count) return;
    uint leaf = refit.first + gl_GlobalInvocationID.x;
    uint first = find_first_position(refit.photon_count, leaf, refit.level);
    uint end = find_first_position(refit.photon_count, leaf + 1u, refit.level);
    vec3 lo = vec3(INFINITY), hi = vec3(-INFINITY);
    for (uint i = 0u; i < TREE_LEAF_PHOTONS; ++i) {
        vec3 p = tree_positions_at(min(first + i, end - 1u)).xyz;
        lo = min(lo, p);
        hi = max(hi, p);
    }
    tree_nodes[(1u << refit.level) + leaf] = TreeNode(vec4(lo, 0.0), vec4(hi, uintBitsToFloat(3u)));
}
