// SPDX-License-Identifier: Apache-2.0
// The kd-tree's node at one level that each pixel's surface falls in, by the splits above it.
// Inputs: surface_points (see_surfaces.comp), tree_nodes. Output: nodes (heap index - 1, NO_CELL: no surface).
#include "shared/prelude.glsl"
#include "shared/inspect.h"
#include "photons/tree_texels.glsl"
#pragma binding texel surface_points
#pragma binding writeonly uint nodes

layout(push_constant) uniform Push { CellSettings settings; };

void main() {
    if (gl_GlobalInvocationID.x >= settings.count) return;
    uint pixel = settings.first + gl_GlobalInvocationID.x;
    vec4 seen = surface_points_at(pixel);
    vec3 point = seen.xyz + settings.shift.xyz;
    uint node = 1u;
    for (uint level = 0u; level < settings.level; ++level) {
        uint axis = floatBitsToUint(tree_nodes_at(2u * node + 1u).w);
        node = 2u * node + uint(point[min(axis, 2u)] >= tree_nodes_at(2u * node).w);
    }
    nodes[pixel] = seen.w < INFINITY ? node - 1u : NO_CELL;
}
