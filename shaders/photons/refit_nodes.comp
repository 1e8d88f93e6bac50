// SPDX-License-Identifier: Apache-2.0
// Boxes of one level of the tree from those of the level below; where nodes were split stays as built.
// In and out: tree_nodes.
#include "shared/prelude.glsl"
#include "photons/tree_layout.glsl"
#pragma binding coherent TreeNode tree_nodes

layout(push_constant) uniform Push { TreeRefit refit; };

void main() {
    if (gl_GlobalInvocationID.x >= refit.count) return;
    uint node = (1u << refit.level) + refit.first + gl_GlobalInvocationID.x;
    TreeNode left = tree_nodes[2u * node];
    TreeNode right = tree_nodes[2u * node + 1u];
    tree_nodes[node].lo_split.xyz = min(left.lo_split.xyz, right.lo_split.xyz);
    tree_nodes[node].hi_axis.xyz = max(left.hi_axis.xyz, right.hi_axis.xyz);
}
