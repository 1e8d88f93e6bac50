// SPDX-License-Identifier: Apache-2.0
// How kernels in which the photons of a map gather from each other are run (shaders/photons/gather.glsl).
#pragma once

#include <functional>

#include "gpu/commands.h"
#include "photons/kd_tree.h"

namespace photonloupe {

// What the kernels are specialised to.
struct GatherShape {
    std::string flat_axes;             // "xz": all photons lie in one plane of these axes and share a normal; "": not
    std::array<float, 3> period{};     // metres after which space repeats; 0: it does not
    std::uint32_t parameter_count = 0; // of those that decide who is a neighbour
    bool has_periodic_parameters = false;
    std::vector<std::uint32_t> range_axes; // parameters whose ranges the tree's nodes know; empty: a tree of positions
};

// Finds out whether all photons of a tree lie in one plane of two axes, with one normal.
std::string find_flat_axes(const KdTree& tree);

// What kernels that look at parameters are specialised to.
std::vector<std::string> list_parameter_defines(const GatherShape& shape);
// What kernels that find the radius of k neighbours are specialised to.
std::vector<std::string> list_gather_defines(const GatherShape& shape, std::uint32_t k);

shared::GatherSettings make_gather_settings(const KdTree& tree, const GatherShape& shape, std::uint32_t k);

// What every gathering kernel binds beside its own.
struct GatherBuffers {
    const gpu::Buffer& singles;    // tree positions of photons that are taken one by one
    const gpu::Buffer& unanswered; // a flag for each subgroup's run of photons
};

// Records one dispatch; gets the kernel and the settings of its chunk.
using GatherDispatch = std::function<void(gpu::Commands&, const gpu::KernelSource&, const shared::GatherSettings&,
                                          const GatherBuffers&, std::uint64_t invocations)>;

// Runs a kernel over all photons of the tree, in tree order; photons that a workgroup's loop turns do not suffice for
// are asked one by one in the end. False if that did not suffice either.
bool try_gather(gpu::Device& device, const KdTree& tree, const std::string& kernel,
                const std::vector<std::string>& defines, const shared::GatherSettings& settings,
                const std::string& stage, const GatherDispatch& dispatch, const Progress& progress);

// Runs a kernel over all photons of the tree, in tree order. Throws Error where photons are so crowded that a
// workgroup cannot look through those it reaches.
void run_gather(gpu::Device& device, const KdTree& tree, const std::string& kernel,
                const std::vector<std::string>& defines, const shared::GatherSettings& settings,
                const std::string& stage, const GatherDispatch& dispatch, const Progress& progress);

// The same for kernels in which a subgroup takes one photon at a time.
void run_gather_singly(gpu::Device& device, const KdTree& tree, const std::string& kernel,
                       const std::vector<std::string>& defines, const shared::GatherSettings& settings,
                       const std::string& stage, const GatherDispatch& dispatch, const Progress& progress);

} // namespace photonloupe
