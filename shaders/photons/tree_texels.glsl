// SPDX-License-Identifier: Apache-2.0
// The kd-tree as kernels read it: tree_nodes (2 texels a node), tree_positions (xyz, w photon id).
#include "photons/tree_layout.glsl"
#pragma binding texel tree_nodes
#pragma binding texel tree_positions
