// SPDX-License-Identifier: Apache-2.0
// Copies the stored photons of one chunk, with their paths, from the scratch slots to the map's columns, in the
// order of emitted indices.
// Inputs: emitters, summaries, path_offsets, block_offsets, scratch_*. Outputs: the photon columns; with RECORD_PATHS the paths.
#include "shared/prelude.glsl"
#include "shared/trace.h"
#pragma binding readonly LightEmission emitters
#pragma binding readonly PathSummary summaries
#pragma binding readonly uvec2 path_offsets
#pragma binding readonly uvec2 block_offsets
#pragma binding texel scratch_position
#pragma binding texel scratch_normal
#pragma binding texel scratch_power
#pragma binding writeonly vec4 position_emitter
#pragma binding writeonly vec4 normal_index
#pragma binding writeonly vec4 power_object
#ifdef RECORD_PATHS
#pragma binding writeonly uint path_starts
#pragma binding writeonly vec4 path_vertices
#pragma binding writeonly vec4 path_normals
#endif

layout(push_constant) uniform Push { TraceSettings settings; };

uint locate_scratch(uint path, uint vertex) { return vertex * settings.chunk_size + path; }

#ifdef RECORD_PATHS
// The path of the photon stored at vertex `last`: everything up to there, the last marked as an end point.
void write_path(uint path, uint last, uint photon, uint first_vertex) {
    path_starts[photon] = first_vertex;
    for (uint vertex = 0u; vertex <= last; ++vertex) {
        vec4 position = scratch_position_at(locate_scratch(path, vertex));
        if (vertex == last) position.w = uintBitsToFloat(INTERACTION_END << 24u | (floatBitsToUint(position.w) & NO_OBJECT));
        path_vertices[first_vertex + vertex] = position;
        path_normals[first_vertex + vertex] = scratch_normal_at(locate_scratch(path, vertex));
    }
}
#endif

void main() {
    uint path = gl_GlobalInvocationID.x;
    if (path >= settings.count) return;
    PathSummary summary = summaries[path];
    uvec2 offset = block_offsets[path / PATHS_PER_BLOCK] + path_offsets[path];
    uint photon = settings.photon_base + offset.x;
    uint first_vertex = settings.vertex_base + offset.y;
    uint light = emitters[summary.outcome >> 8u].first_row.y;
    for (uint vertex = 0u; vertex < summary.vertex_count && summary.photon_count > 0u; ++vertex) {
        uint at = locate_scratch(path, vertex);
        vec4 power = scratch_power_at(at);
        if (power.w == 0.0) continue;
        vec4 position = scratch_position_at(at);
        uint object = floatBitsToUint(position.w) & NO_OBJECT;
        position_emitter[photon] = vec4(position.xyz, uintBitsToFloat(light));
        normal_index[photon] = vec4(scratch_normal_at(at).xyz, uintBitsToFloat(settings.first + path));
        power_object[photon] = vec4(power.rgb, uintBitsToFloat(object));
#ifdef RECORD_PATHS
        write_path(path, vertex, photon, first_vertex);
        first_vertex += vertex + 1u;
#endif
        ++photon;
    }
}
