// SPDX-License-Identifier: Apache-2.0
// Chooses and runs the query kernels.
#include "photons/query_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>

#include <glm/common.hpp>

namespace photonloupe {
namespace {

// Photons the streaming kernel may keep per query.
constexpr std::array<std::uint32_t, 3> CAPACITIES{128, 256, 512};
// Keys sorted at once in registers: a network of twice the size takes the driver many seconds to compile.
constexpr std::uint32_t SORT_BLOCK = 128;
// A list is cut when a subgroup's width may no longer fit; it should take some photons in between.
constexpr double LARGEST_FILL = 0.7;
// Queries a lane answers in turn: the radius found for one is the guess for the next. All of a workgroup's queries
// share one budget of loop turns (shaders/shared/turns.glsl).
constexpr std::uint32_t STREAM_BATCHES = 8;
// Queries a workgroup selects in turn: amortizes its start.
constexpr std::uint32_t SELECT_BATCHES = 4;
// Workgroups in flight: bounds the scratch, and is plenty for any device.
constexpr std::uint64_t LARGEST_GROUP_COUNT = 2048;

std::uint32_t choose_capacity(const gpu::DeviceLimits& limits, std::uint32_t kept) {
    for (const std::uint32_t capacity : CAPACITIES) {
        const std::uint64_t bytes = std::uint64_t{capacity} * limits.subgroup_size * sizeof(std::uint32_t);
        const std::uint64_t others = 1024; // stack and leaf list
        if (kept + 2 * limits.subgroup_size <= capacity && kept <= capacity * LARGEST_FILL &&
            bytes + others <= limits.shared_memory_bytes)
            return capacity;
    }
    return 0;
}

std::string write_copies(std::uint32_t size, bool load) {
    std::ostringstream text;
    text << (load ? "LOAD_KEYS" : "STORE_KEYS");
    for (std::uint32_t i = 0; i < size; ++i)
        if (load)
            text << " key[" << i << "] = keys[locate_key(block * SORT_BLOCK + " << i << "u)];";
        else
            text << " keys[locate_key(block * SORT_BLOCK + " << i << "u)] = key[" << i << "];";
    return text.str();
}

std::vector<std::string> list_stream_defines(const QueryKernels& kernels, std::uint32_t capacity) {
    std::vector<std::string> defines = kernels.defines;
    defines.push_back("CAPACITY " + std::to_string(capacity) + "u");
    defines.push_back("SORT_BLOCK " + std::to_string(SORT_BLOCK) + "u");
    defines.push_back("SORT_NETWORK " + write_sort_network(SORT_BLOCK));
    defines.push_back(write_copies(SORT_BLOCK, true));
    defines.push_back(write_copies(SORT_BLOCK, false));
    return defines;
}

// Entries of the list in shared memory that selecting needs: k, its growth, one leaf; sorting pads to a power of two.
std::uint32_t size_list(std::uint32_t kept) {
    const std::uint32_t grown = kept + std::max(kept / 4, shared::TREE_LEAF_PHOTONS / 2) + shared::TREE_LEAF_PHOTONS;
    return std::max(std::bit_ceil(kept), grown);
}

// Squared radius of a disc that holds k photons if all lie evenly in the two longest directions of the box.
float guess_radius2(const KdTree& tree, std::uint32_t kept) {
    const shared::TreeNode root = tree.nodes.read<shared::TreeNode>(1, 1)[0];
    std::array<double, 3> extent{};
    for (int axis = 0; axis < 3; ++axis)
        extent[axis] = static_cast<double>(root.hi_axis[axis]) - root.lo_split[axis];
    std::sort(extent.begin(), extent.end());
    const double area = extent[2] * std::max(extent[1], 1e-3 * extent[2]);
    const double share = std::min(1.0, static_cast<double>(kept) / static_cast<double>(tree.count));
    return static_cast<float>(std::max(area * share / std::numbers::pi, 1e-30));
}

// One way to run the queries: which kernel, and how many queries a workgroup and its lanes take.
struct QueryRun {
    gpu::KernelSource kernel;
    std::uint32_t batches = 1;
    std::uint64_t per_group = 1;     // queries
    std::uint64_t scratch_bytes = 0; // a workgroup
};

QueryRun plan_stream(const gpu::DeviceLimits& limits, const QueryKernels& kernels, std::uint32_t capacity,
                     std::uint32_t batches) {
    return {{kernels.stream, 0, list_stream_defines(kernels, capacity), {}},
            batches,
            std::uint64_t{limits.subgroup_size} * batches,
            std::uint64_t{capacity} * limits.subgroup_size * sizeof(std::uint32_t)};
}

QueryRun plan_select(const QueryKernels& kernels, std::uint32_t batches) {
    return {{kernels.select, 0, kernels.defines, {size_list(kernels.kept)}}, batches, batches, sizeof(std::uint32_t)};
}

// What to try in turn: fewer queries share a budget each time.
std::vector<QueryRun> plan_runs(const gpu::DeviceLimits& limits, const QueryKernels& kernels) {
    std::vector<QueryRun> runs;
    if (const std::uint32_t capacity = choose_capacity(limits, kernels.kept); capacity > 0)
        runs = {plan_stream(limits, kernels, capacity, STREAM_BATCHES), plan_stream(limits, kernels, capacity, 1)};
    else
        runs = {plan_select(kernels, SELECT_BATCHES)};
    runs.push_back(plan_select(kernels, 1));
    return runs;
}

void run_once(gpu::Device& device, const QueryRun& run, std::span<const std::uint32_t> order,
              const gpu::Buffer& unanswered, shared::NeighborQuery settings, const std::string& stage,
              const QueryDispatch& dispatch, const Progress& progress) {
    const std::uint64_t groups = std::min((order.size() + run.per_group - 1) / run.per_group, LARGEST_GROUP_COUNT);
    const gpu::Buffer order_buffer = gpu::make_buffer(device, order, "query order");
    const gpu::Buffer candidates(device, groups * run.scratch_bytes, "candidates");
    const gpu::Buffer ranked(device, groups * run.scratch_bytes, "ranked candidates");
    settings.batches = run.batches;
    gpu::run_in_chunks(
        device, stage, order.size(), run.per_group, progress,
        [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
            settings.first = static_cast<std::uint32_t>(first);
            settings.count = static_cast<std::uint32_t>(count);
            dispatch(commands, run.kernel, {order_buffer, candidates, ranked, unanswered}, settings,
                     (count + run.per_group - 1) / run.per_group * device.limits().subgroup_size);
        },
        groups * run.per_group);
}

std::uint32_t spread_bits(std::uint32_t x) {
    x = (x | x << 16) & 0x030000ffu;
    x = (x | x << 8) & 0x0300f00fu;
    x = (x | x << 4) & 0x030c30c3u;
    return (x | x << 2) & 0x09249249u;
}

} // namespace

void require_k(std::uint32_t k) {
    if (k < 1 || k > LARGEST_K)
        throw Error("k is " + std::to_string(k) + "; it must be 1 to " + std::to_string(LARGEST_K));
}

std::vector<std::uint32_t> keep_order(std::size_t count) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    return order;
}

std::vector<std::uint32_t> order_points(std::span<const glm::vec4> points) {
    constexpr double CELLS = 1024; // 10 bits an axis
    glm::dvec3 lo(std::numeric_limits<double>::max()), hi(std::numeric_limits<double>::lowest());
    for (const glm::vec4& point : points) {
        lo = glm::min(lo, glm::dvec3(point));
        hi = glm::max(hi, glm::dvec3(point));
    }
    const glm::dvec3 extent = hi - lo;
    const double scale = std::max({extent.x, extent.y, extent.z, 1e-300});
    std::vector<std::uint64_t> keys(points.size()); // Morton code above, index below
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 cell = glm::min((glm::dvec3(points[i]) - lo) / scale * CELLS, glm::dvec3(CELLS - 1));
        const std::uint64_t code = spread_bits(static_cast<std::uint32_t>(cell.x)) |
                                   spread_bits(static_cast<std::uint32_t>(cell.y)) << 1 |
                                   spread_bits(static_cast<std::uint32_t>(cell.z)) << 2;
        keys[i] = code << 32 | i;
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order(points.size());
    std::transform(keys.begin(), keys.end(), order.begin(),
                   [](std::uint64_t key) { return static_cast<std::uint32_t>(key); });
    return order;
}

std::string write_sort_network(std::uint32_t size) {
    std::ostringstream text;
    for (std::uint32_t p = 1; p < size; p *= 2)
        for (std::uint32_t k = p; k >= 1; k /= 2)
            for (std::uint32_t j = k % p; j + k < size; j += 2 * k)
                for (std::uint32_t i = 0; i < std::min(k, size - j - k); ++i)
                    if ((i + j) / (2 * p) == (i + j + k) / (2 * p))
                        text << "EXCHANGE(" << i + j << ", " << i + j + k << ") ";
    return text.str();
}

std::vector<std::uint32_t> run_queries(gpu::Device& device, const KdTree& tree, const QueryKernels& kernels,
                                       std::span<const std::uint32_t> order, shared::NeighborQuery settings,
                                       const std::string& stage, const QueryDispatch& dispatch,
                                       const Progress& progress) {
    if (order.empty())
        return {};
    settings.photon_count = static_cast<std::uint32_t>(tree.count);
    settings.leaf_level = tree.leaf_level;
    settings.guess2 = guess_radius2(tree, kernels.kept);
    const gpu::Buffer unanswered(device, order.size() * sizeof(std::uint32_t), "unanswered queries");
    std::vector<std::uint32_t> left(order.begin(), order.end());
    for (const QueryRun& run : plan_runs(device.limits(), kernels)) {
        // All flags are set: a workgroup that the device stops for its loop turns clears none.
        gpu::Commands commands(device, stage);
        commands.fill(unanswered, 1);
        commands.run();
        run_once(device, run, left, unanswered, settings, stage, dispatch, progress);
        const std::vector<std::uint32_t> flags = unanswered.read<std::uint32_t>(order.size());
        std::erase_if(left, [&](std::uint32_t query) { return flags[query] == 0; });
        if (left.empty())
            break;
    }
    return left;
}

void require_answers(std::span<const std::uint32_t> left, const std::string& stage) {
    if (left.empty())
        return;
    throw Error(stage + ": " + std::to_string(left.size()) + " queries, the first of row " +
                std::to_string(*std::min_element(left.begin(), left.end())) +
                ", reach more photons than one workgroup can look through; are very many photons in one place?");
}

} // namespace photonloupe
