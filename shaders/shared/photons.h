// SPDX-License-Identifier: Apache-2.0
// What the photon-map kernels and the host exchange: tree layout, searches, lists.
#ifndef PHOTONLOUPE_SHARED_PHOTONS_H
#define PHOTONLOUPE_SHARED_PHOTONS_H

#include "shared/types.h"

SHARED_BEGIN

// A photon in a medium has no surface: its normal is the direction it came from, this long, so that no surface's
// estimate takes it for its own (SAME_SURFACE_COSINE is larger) and it is told from others.
const float MEDIUM_NORMAL_LENGTH = 0.5f;
// Normals shorter than this are such.
const float SURFACE_NORMAL_LENGTH = 0.75f;

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
    float parameter_scale; // metres that one unit of parameters counts as; 0: all axes spread alike
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

// Queries, a subgroup's width after the other, gather from the photons of a tree (photons/gather.h).
struct GatherSettings {
    vec4 period; // xyz metres: space repeats, 0: it does not; w unused
    uint first;  // the first query of this dispatch …
    uint count;  // … and how many there are
    uint photon_count;
    uint leaf_level;
    uint rank;          // of the photon that gives the radius, from 1, nearest first
    uint batches;       // subgroups of queries a workgroup takes in turn
    uint includes_last; // the photon of the rank is a member too
    float flatness;     // largest height above the tangent plane, as a share of r; 0: no test
    float carry;        // the radii hold squared radii of this share of what is sought; 0: nothing
    uint stride;        // of so many queries the first alone asks; the others may take its radius
    uint pad1;
    uint pad2;
};

// What marks radii that were carried over from the step before (in w).
const float CARRIED_RADIUS = -1.0f;

// Flag of a query whose radius is known but not how many photons lie at just that radius.
const uint TIES_UNCOUNTED = 2u;

// Members as lists: rows in scratch memory from query row_first on.
// Pairs from one list of k neighbours to the next: even, so that two are a texel.
#define ROW_STRIDE(k) ((k) + (k) % 2u)

struct ListSettings {
    GatherSettings gather;
    uint row_first;
    uint k;
    uint pad1;
    uint pad2;
};

struct SortSettings {
    uint first;
    uint count;
    uint row_first;
    uint k;
};

// How far layers reach: β times the distance to the k-th neighbour in parameter space.
struct ReachSettings {
    uint first;
    uint count;
    uint k;
    float beta;
};

// Kernels of density estimation (METHODS §2).
const uint KERNEL_EPANECHNIKOV = 0u;
const uint KERNEL_DISC = 1u;
const uint KERNEL_CONE = 2u;
const uint KERNEL_GAUSSIAN = 3u;

SHARED_END

#endif
