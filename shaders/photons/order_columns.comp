// SPDX-License-Identifier: Apache-2.0
// Copies photon normals, emitters and rows of ranges into tree order. In: normal_index, position_emitter, range_rows
// (by photon id), tree_positions, emitters (least, complement of greatest). Out: tree_normals (w emitter as bits), tree_rows. Define: RANGE_ROWS.
#include "shared/prelude.glsl"
#pragma binding texel normal_index
#pragma binding texel position_emitter
#pragma binding texel range_rows
#pragma binding texel tree_positions
#pragma binding readonly uint emitters
#pragma binding writeonly vec4 tree_normals
#pragma binding writeonly vec4 tree_rows

layout(push_constant) uniform Push { uint first; uint count; };

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    uint position = first + gl_GlobalInvocationID.x;
    uint photon = floatBitsToUint(tree_positions_at(position).w);
    // A load from anywhere is dear: where there is one emitter any photon tells it.
    uint emitted = emitters[0] == ~emitters[1] ? 0u : photon;
    tree_normals[position] = vec4(normal_index_at(photon).xyz, position_emitter_at(emitted).w);
#ifdef RANGE_ROWS
    for (uint row = 0u; row < RANGE_ROWS; ++row)
        tree_rows[position * RANGE_ROWS + row] = range_rows_at(photon * RANGE_ROWS + row);
#endif
}
