// SPDX-License-Identifier: Apache-2.0
// The photon whose Voronoi cell each pixel's surface lies in: the nearest, ties by id. The walk has no stack: which
// node of the complete tree comes next follows from the one it stands at, so that a walk that ran out of turns goes on
// in the next dispatch.
// Inputs: surface_points, surface_normals (see_surfaces.comp), tree_nodes, tree_positions, tree_normals, and
// normal_bounds (two texels a node: least and greatest components of its photons' normals).
// In and out: walks (x node to visit next, 0: done; y bits of the least measure; z photon).
#include "shared/prelude.glsl"
#include "shared/inspect.h"
#include "photons/same_surface.glsl"
#include "photons/tree_texels.glsl"
#pragma binding texel tree_normals
#pragma binding texel normal_bounds
#pragma binding texel surface_points
#pragma binding texel surface_normals
#pragma binding uvec4 walks

layout(push_constant) uniform Push { CellSettings settings; };

uint turns = 0u;
vec3 point;
vec3 normal;
float least = INFINITY;
uint nearest = NO_CELL;

// What rounding may take from the cosine of a photon against that of its node.
const float COSINE_SLACK = 1e-5;

// Whether some normal within the node's bounds may belong to the pixel's surface.
bool may_face_alike(uint node) {
    vec3 most = max(normal * normal_bounds_at(2u * node).xyz, normal * normal_bounds_at(2u * node + 1u).xyz);
    return settings.flatness == 0.0 || most.x + most.y + most.z + COSINE_SLACK > SAME_SURFACE_COSINE;
}

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
        return faces_alike(normal, tree_normals_at(position).xyz) ? measure_on_surface(offset, make_steep(normal, settings.flatness))
                                                                  : INFINITY;
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

// The child on the point's side of a node's split.
uint find_near_child(uint node) {
    uint axis = floatBitsToUint(tree_nodes_at(2u * node + 1u).w);
    return 2u * node + uint(point[min(axis, 2u)] >= tree_nodes_at(2u * node).w);
}

// The node after a subtree, nearer children first: the sibling of the lowest near child on the way up; 0: none is left.
uint leave_subtree(uint node) {
    bool is_near = false;
    while (node > 1u && !is_near) {
        ++turns;
        is_near = node == find_near_child(node >> 1u);
        node = is_near ? node ^ 1u : node >> 1u;
    }
    return is_near ? node : 0u;
}

uint walk_from(uint node) {
    uint first_leaf = 1u << settings.leaf_level;
    while (node != 0u && turns < settings.turns) {
        ++turns;
        // At the same distance an id may be lower.
        bool is_wanted = measure_box(node) <= least && may_face_alike(node);
        if (is_wanted && node >= first_leaf) scan_leaf(node - first_leaf);
        if (is_wanted && node < first_leaf) node = find_near_child(node);
        else node = leave_subtree(node);
    }
    return node;
}

void main() {
    if (gl_GlobalInvocationID.x >= settings.count) return;
    uint pixel = settings.first + gl_GlobalInvocationID.x;
    uvec4 walk = walks[pixel];
    vec4 seen = surface_points_at(pixel);
    if (walk.x == 0u) return;
    if (!(seen.w < INFINITY)) {
        walks[pixel] = uvec4(0u, walk.yzw);
        return;
    }
    point = seen.xyz + settings.shift.xyz;
    normal = surface_normals_at(pixel).xyz;
    least = uintBitsToFloat(walk.y);
    nearest = walk.z;
    uint node = walk_from(walk.x);
    walks[pixel] = uvec4(node, floatBitsToUint(least), nearest, 0u);
}
