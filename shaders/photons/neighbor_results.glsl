// SPDX-License-Identifier: Apache-2.0
// Lists of neighbors (measure bits, photon id), a query's from row find_list(i) on, and where answers go.
// Inputs: found_lists (two pairs a texel), found_counts, result_rows (the row of each query's answer). Outputs:
// neighbor_ids, neighbor_distances; missing ones are -1 and inf.
#include "shared/photons.h"
#pragma binding texel found_lists
#pragma binding readonly uint found_counts
#pragma binding readonly uint result_rows
#pragma binding writeonly int neighbor_ids
#pragma binding writeonly float neighbor_distances

layout(push_constant) uniform Push { SortSettings settings; };

const uvec2 NOBODY = uvec2(0xffffffffu);

bool is_before(uvec2 a, uvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

// Of query i of the dispatch.
uint find_list(uint i) { return ROW_STRIDE(settings.k) * (settings.first + i - settings.row_first); }
uint get_count(uint i) { return found_counts[settings.first + i - settings.row_first]; }
uint find_result(uint i) { return settings.k * result_rows[settings.first + i]; }

void write_result(uint at, uvec2 entry) {
    neighbor_ids[at] = int(entry.y);
    neighbor_distances[at] = entry == NOBODY ? INFINITY : sqrt(uintBitsToFloat(entry.x));
}
