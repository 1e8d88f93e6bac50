// SPDX-License-Identifier: Apache-2.0
// How nearest-photon queries are run: which kernel suits k, and in which order queries visit the tree.
#pragma once

#include <functional>
#include <span>

#include "gpu/commands.h"
#include "photons/kd_tree.h"

namespace photonloupe {

inline constexpr std::uint32_t LARGEST_K = 1000;

// Throws Error unless k is 1 to LARGEST_K.
void require_k(std::uint32_t k);

// A pair of kernels that answer the same query: `stream` one query a lane (needs `k` within its capacity),
// `select` one query a subgroup, for any k and any photons. Both take shared::NeighborQuery and the bindings of `bind`.
struct QueryKernels {
    std::string stream;
    std::string select;
    std::vector<std::string> defines;
    std::uint32_t kept = 0; // photons the query keeps: k, or k + 1 where the next one gives the radius
};

// Dispatches one kernel; the callee adds its own bindings to the ones given.
struct QueryBuffers {
    const gpu::Buffer& order;      // queries in the order to run them
    const gpu::Buffer& candidates; // scratch of the streaming kernel
    const gpu::Buffer& ranked;     // the same, in order
    const gpu::Buffer& unanswered; // a flag per query, set when its workgroup ran out of loop turns
};

using QueryDispatch = std::function<void(gpu::Commands&, const gpu::KernelSource&, const QueryBuffers&,
                                         const shared::NeighborQuery&, std::uint64_t invocations)>;

// Runs all queries in `order` (a permutation of 0 … order.size() - 1): streaming where k allows it, else selecting.
// What a workgroup did not finish is asked again with more turns each. Returns the queries for which that did not
// suffice either, and the numbers written for them mean nothing.
std::vector<std::uint32_t> run_queries(gpu::Device& device, const KdTree& tree, const QueryKernels& kernels,
                                       std::span<const std::uint32_t> order, shared::NeighborQuery settings,
                                       const std::string& stage, const QueryDispatch& dispatch,
                                       const Progress& progress);

// Throws Error naming the first row unless all queries were answered.
void require_answers(std::span<const std::uint32_t> left, const std::string& stage);

// 0, 1, 2 …: queries that are coherent as they come.
std::vector<std::uint32_t> keep_order(std::size_t count);

// Along a Morton curve, so that neighboring lanes look at neighboring photons.
std::vector<std::uint32_t> order_points(std::span<const glm::vec4> points);

// Comparators of Batcher's odd-even merge sort for `size` (a power of two) values, as calls EXCHANGE(i, j).
std::string write_sort_network(std::uint32_t size);

} // namespace photonloupe
