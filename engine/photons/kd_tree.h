// SPDX-License-Identifier: Apache-2.0
// The kd-tree over a photon map: complete, median splits, leaves of 8 to 16 photons, with the columns queries read
// copied into tree order (METHODS §9).
#pragma once

#include "core/progress.h"
#include "photons/photon_map.h"
#include "shared/photons.h"

namespace photonloupe {

struct KdTree {
    std::uint64_t count = 0;      // photons
    std::uint32_t leaf_level = 0; // the root is level 0
    gpu::Buffer nodes;            // shared::TreeNode by heap index; entry 0 is unused
    gpu::Buffer positions;        // tree order: xyz, w bits: photon id
    gpu::Buffer normals;          // tree order: xyz unit, w bits: emitter
};

// Levels below the root, so that no leaf has more than TREE_LEAF_PHOTONS.
std::uint32_t find_leaf_level(std::uint64_t photon_count);

// Tree position at which node j of a level begins, as in shaders/photons/tree_layout.glsl.
std::uint32_t find_first_position(std::uint64_t count, std::uint64_t node, std::uint32_t level);

// Fills tree.normals from the map, in the order of tree.positions.
void order_normals(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const Progress& progress = {});

KdTree build_tree(gpu::Device& device, const PhotonMap& photons, const Progress& progress = {});

// A tree of its own, whose photons may then move.
KdTree copy_tree(gpu::Device& device, const KdTree& tree);

// Makes all boxes tight again after `positions` changed; order and splits stay.
void refit_tree(gpu::Device& device, const KdTree& tree, const std::string& stage);

// The tree as plain arrays, parents before children: what PhotonMap.tree shows.
struct TreeArrays {
    std::vector<std::int8_t> split_axis; // -1: leaf
    std::vector<float> split_value;      // the right child's first coordinate
    std::vector<std::int32_t> first;     // first photon of the node, in `order`
    std::vector<std::int32_t> count;
    std::vector<std::array<float, 6>> box; // lower corner, upper corner, relative to the map's origin
    std::vector<std::int32_t> order;       // photon ids in tree order
};

TreeArrays read_tree(const KdTree& tree);

} // namespace photonloupe
