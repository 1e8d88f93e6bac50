// SPDX-License-Identifier: Apache-2.0
// The kd-tree over a photon map: complete, median splits, leaves of 8 to 16 photons, with the columns queries read
// copied into tree order (METHODS §9).
#pragma once

#include "core/progress.h"
#include "gpu/commands.h"
#include "photons/photon_map.h"
#include "shared/photons.h"

namespace photonloupe {

// What a tree may be split along beside x, y and z, and whose ranges its nodes then know: a row of numbers a photon.
struct RangeRows {
    std::uint32_t axis_count = 0; // 1–14: layer number, then the parameters
    gpu::Buffer values;           // by photon id: count_rows() vec4s each, the last padded with 0; finite
    std::uint32_t count_rows() const { return (axis_count + 3) / 4; }
};

// What a tree is built of, photon ids being indices: a map's columns, or others.
struct TreePhotons {
    std::uint64_t count = 0;
    const gpu::Buffer& positions; // xyz, w bits: emitter
    const gpu::Buffer& normals;   // xyz unit
    TreePhotons(std::uint64_t photon_count, const gpu::Buffer& places, const gpu::Buffer& directions)
        : count(photon_count), positions(places), normals(directions) {}
    TreePhotons(const PhotonMap& map) : TreePhotons(map.count, map.position_emitter, map.normal_index) {}
};

// Along what nodes are split.
enum class TreeAxes { positions, both, ranges };

struct KdTree {
    std::uint64_t count = 0;      // photons
    std::uint32_t leaf_level = 0; // the root is level 0
    gpu::Buffer nodes;            // shared::TreeNode by heap index; entry 0 is unused
    gpu::Buffer positions;        // tree order: xyz, w bits: photon id
    gpu::Buffer normals;          // tree order: xyz unit, w bits: emitter
    gpu::Buffer normal_boxes; // by heap index: least, then greatest components of its photons' normals; w of the least:
                              // bits of the least photon id
    std::uint32_t range_rows = 0; // 0: a tree of positions alone
    gpu::Buffer rows;             // tree order: range_rows vec4s a photon (layer number, parameters)
    gpu::Buffer ranges;           // by heap index: range_rows vec4s of least, then as many of greatest values
};

// Levels below the root, so that no leaf has more than TREE_LEAF_PHOTONS.
std::uint32_t find_leaf_level(std::uint64_t photon_count);

// Tree position at which node j of a level begins, as in shaders/photons/tree_layout.glsl.
std::uint32_t find_first_position(std::uint64_t count, std::uint64_t node, std::uint32_t level);

// A tree over positions: nodes are split along their widest extent (x before y before z), about the median of
// (coordinate, photon id).
KdTree build_tree(gpu::Device& device, const TreePhotons& photons, const Progress& progress = {});

// A tree whose nodes also know ranges. They are split along the axis of greatest spread: the standard deviation over
// 64 evenly spaced photons of a node, times a scale by which all axes have the same spread over the whole map
// (`ranges`: all but the parameters, whose values are compared as they are).
// With a `parameter_scale` in `both`, parameters count so many metres a unit instead.
KdTree build_tree(gpu::Device& device, const TreePhotons& photons, const RangeRows& ranges, TreeAxes axes,
                  float parameter_scale = 0, const Progress& progress = {});

// Records the filling of tree.normals and, with ranges, of tree.rows from the map, in the order of tree.positions, for
// `count` photons: no more than workgroups of ORDER_GROUP that the device allows. `emitters` holds the least emitter
// and the complement of the greatest.
constexpr std::uint32_t ORDER_GROUP = 64;
void order_columns(gpu::Commands& commands, const TreePhotons& photons, const RangeRows* ranges, const KdTree& tree,
                   const gpu::Buffer& emitters, std::uint64_t first, std::uint64_t count);

// Makes all boxes tight, and with ranges those too.
void bound_tree(gpu::Device& device, const KdTree& tree, const std::string& stage, bool with_ranges);

// A tree of its own, whose photons may then move.
KdTree copy_tree(gpu::Device& device, const KdTree& tree);

// Makes all boxes tight again after positions and normals changed; order, splits and ranges stay.
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
