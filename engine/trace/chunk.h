// SPDX-License-Identifier: Apache-2.0
// One chunk of emitted indices on the device: its scratch memory and the kernels that fill and read it.
#pragma once

#include <vector>

#include "gpu/commands.h"
#include "trace/emitters.h"
#include "trace/trace_photons.h"

namespace photonloupe {

// Scratch memory for up to `size` paths of `slot_count` recorded vertices.
struct ChunkScratch {
    std::uint32_t size = 0;
    std::uint32_t slot_count = 0;
    gpu::Buffer lane_order;
    gpu::Buffer summaries;
    gpu::Buffer deposited_flux;
    gpu::Buffer lost_flux;
    gpu::Buffer emitted_flux; // where an image gives each path its own
    gpu::Buffer position;
    gpu::Buffer normal;
    gpu::Buffer power;
    gpu::Buffer path_offsets;
    gpu::Buffer block_sums;
    gpu::Buffer block_offsets;
    gpu::Buffer balance;
};

// Vertices a path may record: all of them, or only where something can be stored.
std::uint32_t count_slots(const Scene& scene, const TraceSettings& settings);

// The largest chunk (a power of two) whose scratch stays within a storage range.
std::uint32_t find_largest_chunk(const gpu::DeviceLimits& limits, std::uint32_t slot_count);

ChunkScratch allocate_chunk(gpu::Device& device, std::uint32_t size, std::uint32_t slot_count, Emission emission,
                            bool has_color);

// The order in which a chunk's lanes take its emitted indices: neighbours in the Sobol net's elementary intervals
// follow each other, so that lanes that run together follow similar rays. Owen scrambling and a chunk's offset permute
// whole intervals, so one order serves every aligned chunk.
std::vector<std::uint32_t> order_lanes(std::uint32_t size, Emission emission);

} // namespace photonloupe
