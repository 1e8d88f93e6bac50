// SPDX-License-Identifier: Apache-2.0
// Boxes of nodes from their keys. In: box_keys. Out: tree_nodes of one level.
#include "shared/prelude.glsl"
#include "photons/tree_layout.glsl"
#include "photons/box_keys.glsl"
#pragma binding writeonly TreeNode tree_nodes

layout(push_constant) uniform Push { TreeBuild build; };

void main() {
    uint node = gl_GlobalInvocationID.x;
    if (node >= build.count) return;
    tree_nodes[(1u << build.level) + node] =
        TreeNode(vec4(read_box_lo(node), 0.0), vec4(read_box_hi(node), uintBitsToFloat(TREE_LEAF)));
}
