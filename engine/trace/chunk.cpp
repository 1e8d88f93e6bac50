// SPDX-License-Identifier: Apache-2.0
// Sizes and allocates a chunk's scratch, and orders its lanes.
#include "trace/chunk.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <numeric>

#include "shared/random.h"

namespace photonloupe {
namespace {

constexpr std::uint32_t LARGEST_CHUNK = 1u << 20;
// Scratch beyond this gains nothing: a chunk of this size already keeps any device busy.
constexpr std::uint64_t SCRATCH_BYTES = 96ull << 20;

// Interleaves the upper 16 bits of two fractions, u first.
std::uint32_t interleave_bits(std::uint32_t u, std::uint32_t v) {
    const auto spread = [](std::uint32_t x) {
        x = (x | x << 8) & 0x00ff00ffu;
        x = (x | x << 4) & 0x0f0f0f0fu;
        x = (x | x << 2) & 0x33333333u;
        return (x | x << 1) & 0x55555555u;
    };
    return spread(u >> 16) << 1 | spread(v >> 16);
}

} // namespace

std::uint32_t count_slots(const Scene& scene, const TraceSettings& settings) {
    if (settings.paths)
        return settings.max_bounces + 2; // the emitter, the interactions, the storage point
    if (settings.store == Store::caustic && !scene.report.has_mixed_receiver)
        return 1; // the first diffuse surface ends the path
    return settings.max_bounces + 1;
}

std::uint32_t find_largest_chunk(const gpu::DeviceLimits& limits, std::uint32_t slot_count) {
    const std::uint64_t bytes = std::min(limits.max_storage_range, SCRATCH_BYTES);
    std::uint32_t size = LARGEST_CHUNK;
    while (size > shared::EMISSION_BLOCK && std::uint64_t{size} * slot_count * sizeof(glm::vec4) > bytes)
        size /= 2;
    return size;
}

std::vector<std::uint32_t> order_lanes(std::uint32_t size, Emission emission) {
    std::vector<std::uint32_t> order(size);
    std::iota(order.begin(), order.end(), 0u);
    if (emission == Emission::random)
        return order;
    // Of a (0, 2)-sequence each elementary interval holds one of the first 2^n points: its number is the point's place.
    assert(std::has_single_bit(size) && size > 1);
    const int unused_bits = std::countl_zero(size) + 1;
    for (std::uint32_t i = 0; i < size; ++i)
        order[interleave_bits(shared::sobol_bits(i, 0), shared::sobol_bits(i, 1)) >> unused_bits] = i;
    return order;
}

ChunkScratch allocate_chunk(gpu::Device& device, std::uint32_t size, std::uint32_t slot_count, Emission emission,
                            bool has_color) {
    const std::uint64_t vec4s = std::uint64_t{size} * sizeof(glm::vec4);
    const std::uint64_t blocks = size / shared::PATHS_PER_BLOCK;
    ChunkScratch scratch;
    scratch.size = size;
    scratch.slot_count = slot_count;
    scratch.lane_order = gpu::make_buffer(device, order_lanes(size, emission), "lane order");
    scratch.summaries = gpu::Buffer(device, size * sizeof(shared::PathSummary), "path summaries");
    scratch.deposited_flux = gpu::Buffer(device, vec4s, "deposited flux");
    scratch.lost_flux = gpu::Buffer(device, vec4s, "lost flux");
    scratch.emitted_flux = gpu::Buffer(device, has_color ? vec4s : sizeof(glm::vec4), "emitted flux");
    scratch.position = gpu::Buffer(device, vec4s * slot_count, "scratch vertices");
    scratch.normal = gpu::Buffer(device, vec4s * slot_count, "scratch vertices");
    scratch.power = gpu::Buffer(device, vec4s * slot_count, "scratch vertices");
    scratch.path_offsets = gpu::Buffer(device, std::uint64_t{size} * sizeof(glm::uvec2), "path offsets");
    scratch.block_sums = gpu::Buffer(device, blocks * sizeof(glm::uvec2), "block sums");
    scratch.block_offsets = gpu::Buffer(device, (blocks + 1) * sizeof(glm::uvec2), "block offsets");
    scratch.balance = gpu::Buffer(device, blocks * sizeof(shared::BalanceSum), "balance");
    return scratch;
}

} // namespace photonloupe
