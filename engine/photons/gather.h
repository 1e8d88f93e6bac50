// SPDX-License-Identifier: Apache-2.0
// The one ladder by which queries are answered, whatever the photons are like: side by side; what that leaves, one by
// one, each going on where the dispatch before stopped until it is done.
#pragma once

#include "photons/neighborhood.h"
#include "photons/search_space.h"

namespace photonloupe {

// Throws Error unless k is 1 to MOST_NEIGHBORS.
void require_k(std::uint32_t k);

// Of photons that ask for `neighbors` others: they count themselves, and the next one gives the radius.
constexpr std::uint32_t rank_for(std::uint32_t neighbors) {
    return neighbors + 2;
}

// Of which photon the measure is sought.
struct RadiusSettings {
    std::uint32_t rank = 0;     // from 1, nearest first; photons that ask count themselves
    bool cuts_ties = false;     // members count whole, ties going to the nearer and then to the lower id …
    bool includes_last = false; // … and the photon of the rank is one of them
    bool leaves_self_out = false;
    bool needs_ties = true;   // the weight of photons at just the radius is wanted
    float carry = 0;          // the radii hold squared radii of this share of what is sought; 0: nothing
    bool is_carried = false;  // those that are marked as carried over stay
    std::uint32_t stride = 1; // of so many queries only the first asks; `queries.count` counts those
};

// Bytes of a radius: a vec4, see shaders/photons/search_radius.glsl.
inline constexpr std::uint64_t RADIUS_BYTES = 16;

// Finds the radius of every query.
void find_radii(gpu::Device& device, const Neighborhood& neighborhood, const Queries& queries,
                const RadiusSettings& settings, const gpu::Buffer& radii, const std::string& stage,
                const Progress& progress);

// A kernel in which queries meet their members; its push constants begin with shared::GatherSettings.
struct GatherKernel {
    std::string path;
    std::vector<std::string> defines;
    std::vector<gpu::Binding> bindings; // beside the tree's and the queries'
    bool takes_subgroups = false;       // a subgroup takes one query at a time
    std::uint32_t saved_words = 0;      // of a query that is not through; 0: as of photons/stream_members.glsl
};

// What find_radii() and the other two dispatch first, side by side; few queries are left to the kernels for those one
// by one. Of a neighborhood only what it is counts, its tree may still be empty.
gpu::KernelSource name_radius_kernel(const Neighborhood& neighborhood, const Queries& queries,
                                     const RadiusSettings& settings);
gpu::KernelSource name_gather_kernel(const Neighborhood& neighborhood, const Queries& queries,
                                     const GatherKernel& kernel);

shared::GatherSettings make_gather_settings(const Neighborhood& neighborhood, std::uint32_t rank);

// Runs a kernel over queries first … first + count - 1.
void run_gather(gpu::Device& device, const Neighborhood& neighborhood, const Queries& queries,
                const GatherKernel& kernel, std::span<const std::byte> push, std::uint64_t first, std::uint64_t count,
                const std::string& stage, const Progress& progress);

// Runs it once, side by side; returns the queries it left.
std::vector<std::uint32_t> gather_once(gpu::Device& device, const Neighborhood& neighborhood, const Queries& queries,
                                       const GatherKernel& kernel, std::span<const std::byte> push,
                                       const std::string& stage, const Progress& progress);

// The same over all of them.
template <class Push>
void gather(gpu::Device& device, const Neighborhood& neighborhood, const Queries& queries, const GatherKernel& kernel,
            const Push& push, const std::string& stage, const Progress& progress) {
    run_gather(device, neighborhood, queries, kernel, std::as_bytes(std::span(&push, 1)), 0, queries.count, stage,
               progress);
}

} // namespace photonloupe
