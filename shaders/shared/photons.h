// SPDX-License-Identifier: Apache-2.0
// What the photon-map kernels and the host exchange: tree layout, neighbour queries.
#ifndef PHOTONLOUPE_SHARED_PHOTONS_H
#define PHOTONLOUPE_SHARED_PHOTONS_H

#include "shared/types.h"

SHARED_BEGIN

// The kd-tree is complete: node 1 is the root, node i has children 2i and 2i + 1. Photons stand in tiles of TREE_TILE;
// of T tiles node j of level l (heap index 2^l + j) owns floor(T j / 2^l) … floor(T (j + 1) / 2^l) - 1, so that a tile
// lies within one leaf. Leaves hold 8 to 16 photons.
const uint TREE_TILE = 8u;
const uint TREE_LEAF_PHOTONS = 16u;
// Levels a traversal descends at once: one lane tests one of 2^3 descendants.
const uint TREE_STEP_LEVELS = 3u;
const uint TREE_FANOUT = 8u;
// Entries of the traversal stack: at most 7 wait per step of three levels, 27 levels.
const uint TREE_STACK_SIZE = 72u;

const uint TREE_LEAF = 255u;

// A node's tight box and how it is split.
struct TreeNode {
    vec4 lo_split; // xyz lower corner, w split value
    vec4 hi_axis;  // xyz upper corner, w bits: split axis, 3 + range axis, TREE_LEAF for a leaf
};

// Nodes first … first + count - 1 of one level are split.
struct TreeBuild {
    uint photon_count;
    uint leaf_level;
    uint level;
    uint first;
    uint count;
    uint parts; // a large node's, of TREE_PART photons each but the last
    uint round; // how often its bracket was tried
};

// What one subgroup does of work that several share.
const uint TREE_PART = 2048u;

// A large node while it is split: keys of its photons along `axis` are sought in [lo, hi) and known to be in
// [least, greatest); each is a value's key and a place.
struct TreeBracket {
    uvec4 lo_hi;
    uvec4 least_greatest;
    uint axis;
    uint below;       // keys before lo …
    uint kept;        // … and in [lo, hi)
    uint below_least; // keys before `least` …
    uint within;      // … and in [least, greatest)
    uint is_settled;
    uint pad0;
    uint pad1;
};

// Boxes made anew after photons moved, nodes first … first + count - 1 of one level.
struct TreeRefit {
    uint photon_count;
    uint level;
    uint first;
    uint count;
};

struct NeighborQuery {
    uint first;
    uint count;
    uint photon_count;
    uint leaf_level;
    uint k;
    uint batches;      // queries each lane (each workgroup, when selecting) answers in turn
    uint exclude_self; // the query's w holds the id of a photon that is not its own neighbour
    float flatness;    // irradiance: largest height above the tangent plane, as a share of r; 0: no test
    float guess2;      // squared radius that the first query of a workgroup tries
    float limit2;      // parameter space: beyond every squared distance
    uint pad0;
    uint pad1;
    vec4 period;       // of the tree's axes, 0: none; w unused
};

// Where neighbours are sought, and among whom.
const uint SPACE_WORLD = 0u;
const uint SPACE_PARAMETER = 1u;
const uint SPACE_CONSTRAINED = 2u;
const uint ANY_EMITTER = 0xffffffffu;

// Photons of a map, a tile after the other in tree order, gather from each other (photons/gather.glsl).
struct GatherSettings {
    vec4 period; // xyz metres: space repeats, 0: it does not; w unused
    uint first;  // tree position of the first photon of this dispatch …
    uint count;  // … and how many there are
    uint photon_count;
    uint leaf_level;
    uint k;         // neighbours; the next one gives the radius
    uint batches;   // subgroups of photons a workgroup takes in turn
    float flatness; // largest height above the tangent plane, as a share of r; 0: no test
    float carry;    // the radii hold squared radii of this share of what is sought; 0: nothing
};

// Kernels of density estimation (METHODS §2).
const uint KERNEL_EPANECHNIKOV = 0u;
const uint KERNEL_DISC = 1u;
const uint KERNEL_CONE = 2u;
const uint KERNEL_GAUSSIAN = 3u;

SHARED_END

#endif
