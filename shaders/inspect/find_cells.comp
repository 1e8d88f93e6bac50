// SPDX-License-Identifier: Apache-2.0
// The photon whose Voronoi cell each pixel's surface lies in: the nearest, ties by id. The walk has no stack: of a
// complete tree the node behind a subtree follows from its index, so that a walk that ran out of turns goes on in the
// next dispatch from where it stood.
// Inputs: surface_points, surface_normals (see_surfaces.comp), tree_nodes, tree_positions, tree_normals.
// In and out: walks (x node to visit next, 0: done; y bits of the least measure; z photon).
#include "shared/prelude.glsl"
#include "shared/inspect.h"
#include "photons/same_surface.glsl"
#include "photons/tree_texels.glsl"
#pragma binding texel tree_normals
#pragma binding readonly vec4 surface_points
#pragma binding readonly vec4 surface_normals
#pragma binding uvec4 walks

layout(push_constant) uniform Push { CellSettings settings; };

uint turns = 0u;
vec3 point;
vec3 normal;
float least = INFINITY;
uint nearest = NO_CELL;

// Squared distance to a node's box, in the order of operations of a photon's: never above it.
float measure_box(uint node) {
    vec3 lo = tree_nodes_at(2u * node).xyz;
    vec3 hi = tree_nodes_at(2u * node + 1u).xyz;
    vec3 gap = max(max(lo - point, point - hi), vec3(0.0));
    precise float squared = gap.x * gap.x + gap.y * gap.y + gap.z * gap.z;
    return squared;
}

float measure_photon(uint position, vec3 offset) {
    if (settings.flatness > 0.0)
        return measure_on_surface(offset, normal, tree_normals_at(position).xyz, settings.flatness);
    precise float squared = offset.x * offset.x + offset.y * offset.y + offset.z * offset.z;
    return squared;
}

void scan_leaf(uint leaf) {
    uint end = find_first_position(settings.photon_count, leaf + 1u, settings.leaf_level);
    for (uint at = find_first_position(settings.photon_count, leaf, settings.leaf_level); at < end; ++at) {
        ++turns;
        vec4 photon = tree_positions_at(at);
        uint id = floatBitsToUint(photon.w);
        float measure = measure_photon(at, photon.xyz - point);
        bool is_nearer = measure < least || (measure == least && measure < INFINITY && id < nearest);
        least = is_nearer ? measure : least;
        nearest = is_nearer ? id : nearest;
    }
}

// Its leaf's photons bound the walk from the start.
void scan_own_leaf() {
    uint node = 1u;
    for (uint level = 0u; level < settings.leaf_level; ++level) {
        ++turns;
        uint axis = floatBitsToUint(tree_nodes_at(2u * node + 1u).w);
        node = 2u * node + uint(point[min(axis, 2u)] >= tree_nodes_at(2u * node).w);
    }
    scan_leaf(node - (1u << settings.leaf_level));
}

// The node after a subtree in depth-first order, 0 after the last.
uint skip_subtree(uint node) {
    uint next = (node + 1u) >> uint(findLSB(node + 1u));
    return next == 1u ? 0u : next;
}

uint walk_from(uint node) {
    uint first_leaf = 1u << settings.leaf_level;
    while (node != 0u && turns < settings.turns) {
        ++turns;
        bool is_wanted = measure_box(node) <= least; // at the same distance an id may be lower
        if (is_wanted && node >= first_leaf) scan_leaf(node - first_leaf);
        node = is_wanted && node < first_leaf ? 2u * node : skip_subtree(node);
    }
    return node;
}

void main() {
    if (gl_GlobalInvocationID.x >= settings.count) return;
    uint pixel = settings.first + gl_GlobalInvocationID.x;
    uvec4 walk = walks[pixel];
    vec4 seen = surface_points[pixel];
    if (walk.x == 0u) return;
    if (!(seen.w < INFINITY)) {
        walks[pixel] = uvec4(0u, walk.yzw);
        return;
    }
    point = seen.xyz + settings.shift.xyz;
    normal = surface_normals[pixel].xyz;
    least = uintBitsToFloat(walk.y);
    nearest = walk.z;
    if (nearest == NO_CELL && walk.x == 1u) scan_own_leaf();
    uint node = walk_from(walk.x);
    walks[pixel] = uvec4(node, floatBitsToUint(least), nearest, 0u);
}
