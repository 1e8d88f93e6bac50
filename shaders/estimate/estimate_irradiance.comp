// SPDX-License-Identifier: Apache-2.0
// Irradiance in W/m² at arbitrary points. Inputs: the tree, query_points, query_normals. Output: irradiance.
// Define KERNEL (see shared/photons.h).
#include "shared/prelude.glsl"
#include "estimate/gather.glsl"
#pragma binding readonly vec4 query_points
#pragma binding readonly vec4 query_normals
#pragma binding writeonly vec4 irradiance

layout(push_constant) uniform Push { NeighborQuery settings; };

void main() {
    gather_flatness = settings.flatness;
    for (uint i = 0u; i < settings.queries_per_group; ++i) {
        uint at = gl_WorkGroupID.x * settings.queries_per_group + i;
        if (at >= settings.count) return;
        uint query = settings.first + at;
        gather_point = query_points[query].xyz;
        gather_normal = query_normals[query].xyz;
        vec3 estimate = estimate_irradiance(settings.photon_count, settings.leaf_level, settings.k);
        if (LANE == 0u) irradiance[query] = vec4(estimate, 0.0);
    }
}
