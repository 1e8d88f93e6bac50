// SPDX-License-Identifier: Apache-2.0
// Irradiance in W/m² at arbitrary points; w: what photons that each carry 1 W would give. Inputs: the tree, query_points, query_normals, query_order. Outputs: irradiance, unanswered
// (1: the turns did not suffice).
// Define KERNEL (see shared/photons.h).
#include "shared/prelude.glsl"
#include "estimate/select_gather.glsl"
#pragma binding readonly vec4 query_points
#pragma binding readonly vec4 query_normals
#pragma binding readonly uint query_order
#pragma binding writeonly vec4 irradiance
#pragma binding writeonly uint unanswered

layout(push_constant) uniform Push { NeighborQuery settings; };

void main() {
    gather_flatness = settings.flatness;
    for (uint i = 0u; i < settings.batches; ++i) {
        uint at = gl_WorkGroupID.x * settings.batches + i;
        if (at >= settings.count) return;
        uint query = query_order[settings.first + at];
        gather_point = query_points[query].xyz;
        gather_normal = query_normals[query].xyz;
        vec4 estimate = estimate_irradiance(settings.photon_count, settings.leaf_level, settings.k);
        if (LANE == 0u) {
            irradiance[query] = estimate;
            unanswered[query] = uint(!has_turns_left());
        }
    }
}
