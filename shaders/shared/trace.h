// SPDX-License-Identifier: Apache-2.0
// What the tracing kernels and the host exchange: settings, emission tables, path summaries.
#ifndef PHOTONLOUPE_SHARED_TRACE_H
#define PHOTONLOUPE_SHARED_TRACE_H

#include "shared/types.h"

SHARED_BEGIN

// Which deposits become photons (METHODS §1: L S+ D, at least one bounce of any kind, also direct hits).
const uint STORE_CAUSTIC = 0u;
const uint STORE_INDIRECT = 1u;
const uint STORE_ALL = 2u;

const uint EMISSION_SOBOL = 0u;
const uint EMISSION_RANDOM = 1u;

// How a path ended.
const uint OUTCOME_ABSORBED = 0u;
const uint OUTCOME_ESCAPED = 1u;
const uint OUTCOME_TRUNCATED = 2u;
const uint OUTCOME_RECEIVED = 3u;
const uint OUTCOME_UNFINISHED = 4u; // the workgroup's loop turns did not suffice; never in a finished map

// Interaction at a path vertex, as the script language reports it.
const uint INTERACTION_END = 0u;
const uint INTERACTION_REFLECTED = 1u;
const uint INTERACTION_TRANSMITTED = 2u;
const uint INTERACTION_SCATTERED = 3u; // by a medium

// Object index of vertices that lie on no surface (a point light).
const uint NO_OBJECT = 0xffffffu;

// Paths summed by one invocation; also the unit in which offsets are scanned.
const uint PATHS_PER_BLOCK = 64u;
// Emitted indices are kept or dropped in whole blocks of this many.
const uint EMISSION_BLOCK = 4096u;

struct TraceSettings {
    uint first;        // emitted index of the chunk's first path
    uint count;        // paths in the chunk
    uint seed;
    uint max_bounces;
    uint slot_count;   // scratch vertices of one path
    uint light_count;
    uint chunk_size;   // stride between the scratch slots of one path
    uint photon_base;  // photons and path vertices already in the map
    uint vertex_base;
    uint paths_per_lane; // one lane shoots these in turn
    uint pad1;
    uint pad2;
};

// A light with its projection map: photons are drawn from marked cells of a rows × columns grid of equal power.
struct LightEmission {
    vec4 position_kind; // xyz (directional: corner of the plane of starts), kind as bits
    vec4 flux_cumulative; // rgb: flux in W carried by a photon of this light times the number emitted; w: cumulative probability
    uvec4 grid;         // rows, columns, first entry in `cells`, number of marked cells
    uvec4 first_row;    // x: first entry in `cell_rows`, y: the light's index in the scene; area: z: first triangle, w: their number
    vec4 u_axis;        // xyz: EmissionFrame's u, axis and v; w bits: the medium that light starts in (Media::inner)
    vec4 v_axis;        // w bits: the one around it
    vec4 axis_sides;    // area: w sides that shine
    vec4 cone;          // spot: xy 1 - cos of the inner and the outer angle; environment: radius of the discs of starts, their distance, z 1: an image says it
};

// One path's end: outcome, recorded vertices, photons stored, vertices of the stored photons' paths together.
struct PathSummary {
    uint outcome;
    uint vertex_count;
    uint photon_count;
    uint photon_vertex_count;
};

// Per-block sums for the balance: paths by outcome, flux by fate.
struct BalanceSum {
    uvec4 paths;     // absorbed, escaped, truncated, received
    vec4 emitted;    // rgb; w: unfinished paths
    vec4 deposited;  // rgb, sum over all events of flux in minus flux out
    vec4 escaped;    // rgb
    vec4 truncated;  // rgb
};

SHARED_END

#endif
