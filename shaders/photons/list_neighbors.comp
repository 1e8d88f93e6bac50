// SPDX-License-Identifier: Apache-2.0
// Lists the members of each query in any order. Inputs: the tree, the queries, radii. Outputs: found_neighbors (rows of
// ROW_STRIDE pairs from query row_first on: measure bits, id), found_counts, unanswered.
#include "shared/prelude.glsl"
#include "photons/candidates.glsl"

layout(push_constant) uniform Push { ListSettings settings; };

#pragma binding coherent uvec2 found_neighbors
#pragma binding writeonly uint found_counts

float listed; // a sum, so that it is saved with the walk
uint my_row;
#define EACH_SUM(DO) DO(listed)

void accumulate(Candidate other, float weight) {
    if (weight > 0.0) found_neighbors[my_row + uint(listed)] = uvec2(floatBitsToUint(measure_candidate(other)), other.id);
    listed += weight;
}

#include "photons/stream_members.glsl"
#include "photons/take_turns.glsl"
#pragma binding texel radii

void main() {
    for (uint batch = 0u; batch < BATCH_COUNT(settings.gather); ++batch) {
        uint query;
        bool has_query = take_turn(settings.gather, batch, query);
        take_query(query, settings.gather.period, settings.gather.flatness);
        vec4 radius = radii_at(query);
        listed = 0.0;
        my_row = ROW_STRIDE(settings.k) * (query - settings.row_first);
        bool is_listed = stream_members(settings.gather, has_query && radius.w > 0.0, radius);
        if (has_query) found_counts[query - settings.row_first] = uint(listed);
        report_turn(settings.gather, has_query, is_listed, query);
    }
}
