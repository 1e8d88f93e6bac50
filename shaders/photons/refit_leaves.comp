// SPDX-License-Identifier: Apache-2.0
// Boxes of the tree's leaves about where their photons are now, of their normals too, with the least id, and ranges where asked for.
// In: tree_positions, tree_normals, tree_rows. Out: tree_nodes, normal_boxes, ranges (leaves). Define: RANGE_ROWS.
#include "shared/prelude.glsl"
#include "photons/tree_layout.glsl"
#pragma binding texel tree_positions
#pragma binding texel tree_normals
#pragma binding texel tree_rows
#pragma binding coherent TreeNode tree_nodes
#pragma binding writeonly vec4 normal_boxes
#pragma binding writeonly vec4 ranges

layout(push_constant) uniform Push { TreeRefit refit; };

void main() {
    if (gl_GlobalInvocationID.x >= refit.count) return;
    uint leaf = refit.first + gl_GlobalInvocationID.x;
    uint first = find_first_position(refit.photon_count, leaf, refit.level);
    uint end = find_first_position(refit.photon_count, leaf + 1u, refit.level);
    uint node = (1u << refit.level) + leaf;
    uint least_id = 0xffffffffu;
    vec3 lo = vec3(INFINITY), hi = vec3(-INFINITY), normal_lo = lo, normal_hi = hi;
    for (uint i = 0u; i < TREE_LEAF_PHOTONS; ++i) {
        uint at = min(first + i, end - 1u);
        vec4 photon = tree_positions_at(at);
        vec3 p = photon.xyz;
        vec3 normal = tree_normals_at(at).xyz;
        lo = min(lo, p);
        hi = max(hi, p);
        least_id = min(least_id, floatBitsToUint(photon.w));
        normal_lo = min(normal_lo, normal);
        normal_hi = max(normal_hi, normal);
    }
    tree_nodes[node] = TreeNode(vec4(lo, 0.0), vec4(hi, uintBitsToFloat(TREE_LEAF)));
    normal_boxes[2u * node] = vec4(normal_lo, uintBitsToFloat(least_id));
    normal_boxes[2u * node + 1u] = vec4(normal_hi, 0.0);
#ifdef RANGE_ROWS
    for (uint row = 0u; row < RANGE_ROWS; ++row) {
        vec4 least = vec4(INFINITY), greatest = vec4(-INFINITY);
        for (uint i = 0u; i < TREE_LEAF_PHOTONS; ++i) {
            vec4 values = tree_rows_at(min(first + i, end - 1u) * RANGE_ROWS + row);
            least = min(least, values);
            greatest = max(greatest, values);
        }
        ranges[2u * RANGE_ROWS * node + row] = least;
        ranges[(2u * node + 1u) * RANGE_ROWS + row] = greatest;
    }
#endif
}
