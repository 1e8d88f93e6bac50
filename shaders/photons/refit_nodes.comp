// SPDX-License-Identifier: Apache-2.0
// Boxes of one level of the tree from those of the level below, of positions and of normals, with the least id, and ranges where asked
// for; where nodes were split stays as built. In and out: tree_nodes, normal_boxes, ranges. Define: RANGE_ROWS.
#include "shared/prelude.glsl"
#include "photons/tree_layout.glsl"
#pragma binding coherent TreeNode tree_nodes
#pragma binding coherent vec4 normal_boxes
#pragma binding coherent vec4 ranges

layout(push_constant) uniform Push { TreeRefit refit; };

void main() {
    if (gl_GlobalInvocationID.x >= refit.count) return;
    uint node = (1u << refit.level) + refit.first + gl_GlobalInvocationID.x;
    TreeNode left = tree_nodes[2u * node];
    TreeNode right = tree_nodes[2u * node + 1u];
    tree_nodes[node].lo_split.xyz = min(left.lo_split.xyz, right.lo_split.xyz);
    tree_nodes[node].hi_axis.xyz = max(left.hi_axis.xyz, right.hi_axis.xyz);
    vec4 left_normals = normal_boxes[4u * node], right_normals = normal_boxes[4u * node + 2u];
    uint least_id = min(floatBitsToUint(left_normals.w), floatBitsToUint(right_normals.w));
    normal_boxes[2u * node] = vec4(min(left_normals.xyz, right_normals.xyz), uintBitsToFloat(least_id));
    normal_boxes[2u * node + 1u] = max(normal_boxes[4u * node + 1u], normal_boxes[4u * node + 3u]);
#ifdef RANGE_ROWS
    for (uint row = 0u; row < RANGE_ROWS; ++row) {
        uint below = 4u * node * RANGE_ROWS + row; // of the left child; the right one's follow its greatest
        ranges[2u * RANGE_ROWS * node + row] = min(ranges[below], ranges[below + 2u * RANGE_ROWS]);
        ranges[(2u * node + 1u) * RANGE_ROWS + row] =
            max(ranges[below + RANGE_ROWS], ranges[below + 3u * RANGE_ROWS]);
    }
#endif
}
