// SPDX-License-Identifier: Apache-2.0
// Specialises and dispatches the searching and gathering kernels.
#include "photons/gather.h"

#include <algorithm>
#include <cstring>

#include "photons/kernel_macros.h"

namespace photonloupe {
namespace {

// Photons kept in order above the bound (shaders/photons/search_radius.glsl). Each costs two operations for every
// photon that streams by, a bound that misses costs a pass.
constexpr std::uint32_t SMALLEST_SHELL = 4;
constexpr std::uint32_t LARGEST_SHELL = 12;
// Workgroups of the first chunk of work: fewer would leave the device idle while chunks grow.
constexpr std::uint64_t FIRST_GROUPS = 64;
// Subgroups of queries a workgroup takes in turn: amortises its start; they share its loop turns.
constexpr std::uint32_t BATCHES = 8;
// Queries taken one by one that are under way together: bounds what is kept of them.
constexpr std::size_t LARGEST_SINGLE_COUNT = 4096;
// Words of a walk that is not over, and of its sums (shaders/photons/stream_members.glsl).
constexpr std::uint32_t SAVED_WALK_WORDS = 32;
constexpr std::uint32_t SAVED_SEARCH_HEAD = 6; // shaders/photons/select_radius.comp

// Entries of the shell: all that are sought where that is few, and one more to tell whether it ties.
std::uint32_t size_shell(std::uint32_t rank) {
    return std::clamp(rank + 1, SMALLEST_SHELL, LARGEST_SHELL);
}

// Entries of the list that selecting needs: the rank, its growth, a leaf; the last is taken in tiles of a subgroup.
std::uint32_t size_list(std::uint32_t rank, std::uint32_t subgroup_size) {
    return rank + std::max(rank / 4, shared::TREE_LEAF_PHOTONS / 2) +
           std::max(shared::TREE_LEAF_PHOTONS, subgroup_size) + 2;
}

// What one gather is about.
struct Gathering {
    gpu::Device& device;
    const Neighborhood& neighborhood;
    const Queries& queries;
    const std::string& stage;
    const Progress& progress;

    std::vector<gpu::Binding> bind(const std::vector<gpu::Binding>& more) const {
        std::vector<gpu::Binding> bindings = list_bindings(neighborhood, queries);
        for (const gpu::Binding& binding : more)
            bindings.push_back(binding);
        return bindings;
    }
};

// Runs `kernel` over [first, first + count) of what it counts in, `per_group` to a workgroup of one subgroup.
void run_chunks(const Gathering& about, const gpu::KernelSource& kernel, const std::vector<gpu::Binding>& bindings,
                std::span<const std::byte> push, std::uint64_t first, std::uint64_t count, std::uint64_t per_group) {
    std::vector<std::byte> bytes(push.begin(), push.end());
    gpu::run_in_chunks(
        about.device, about.stage, count, per_group * FIRST_GROUPS, about.progress,
        [&](gpu::Commands& commands, std::uint64_t begin, std::uint64_t size) {
            shared::GatherSettings settings;
            std::memcpy(&settings, bytes.data(), sizeof settings);
            settings.first = static_cast<std::uint32_t>(first + begin);
            settings.count = static_cast<std::uint32_t>(size);
            std::memcpy(bytes.data(), &settings, sizeof settings);
            commands.dispatch_bytes(kernel, bindings, bytes,
                                    (size + per_group - 1) / per_group * about.device.limits().subgroup_size);
        },
        per_group * about.device.limits().max_group_count);
}

// Runs the kernel side by side; queries that were left.
std::vector<std::uint32_t> run_side_by_side(const Gathering& about, const gpu::KernelSource& kernel,
                                            const std::vector<gpu::Binding>& more, std::span<const std::byte> push,
                                            std::uint64_t first, std::uint64_t count, bool takes_subgroups) {
    // All flags are set: a workgroup that the device stops for its loop turns clears none.
    const gpu::Buffer unanswered(about.device, (first + count) * sizeof(std::uint32_t), "unanswered queries");
    gpu::fill(about.device, about.stage, unanswered, 1);
    const gpu::Buffer none = gpu::make_buffer(about.device, std::vector<glm::uvec2>(1), "single queries");
    std::vector<gpu::Binding> bindings = about.bind(more);
    for (const char* name : {"singles", "saved_walks", "saved_lists"})
        bindings.push_back({name, none});
    bindings.push_back({"unanswered", unanswered});
    const std::uint64_t per_group = takes_subgroups ? 1 : std::uint64_t{about.device.limits().subgroup_size} * BATCHES;
    run_chunks(about, kernel, bindings, push, first, count, per_group);
    const std::vector<std::uint32_t> flags = unanswered.read<std::uint32_t>(count, first);
    std::vector<std::uint32_t> left;
    for (std::size_t i = 0; i < flags.size(); ++i)
        if (flags[i])
            left.push_back(static_cast<std::uint32_t>(first + i));
    return left;
}

// Runs the kernel a query at a time, again and again where it is not through; every dispatch brings each query on.
// Returns those that ended with the flag TIES_UNCOUNTED.
std::vector<std::uint32_t> run_singly(const Gathering& about, const gpu::KernelSource& kernel,
                                      const std::vector<gpu::Binding>& more, std::span<const std::byte> push,
                                      std::span<const std::uint32_t> queries, std::uint32_t saved_words) {
    std::vector<std::uint32_t> uncounted;
    for (std::size_t begin = 0; begin < queries.size(); begin += LARGEST_SINGLE_COUNT) {
        const std::span<const std::uint32_t> part =
            queries.subspan(begin, std::min(LARGEST_SINGLE_COUNT, queries.size() - begin));
        const gpu::Buffer saved(about.device, part.size() * saved_words * sizeof(std::uint32_t), "saved searches");
        const gpu::Buffer unanswered(about.device, part.size() * sizeof(std::uint32_t), "unanswered queries");
        gpu::Commands commands(about.device, about.stage);
        commands.fill(saved, 0);
        commands.fill(unanswered, 1);
        commands.run();
        std::vector<glm::uvec2> left; // query, slot
        for (std::size_t slot = 0; slot < part.size(); ++slot)
            left.emplace_back(part[slot], static_cast<std::uint32_t>(slot));
        while (!left.empty()) {
            const gpu::Buffer singles = gpu::make_buffer(about.device, left, "single queries");
            std::vector<gpu::Binding> bindings = about.bind(more);
            for (const char* name : {"saved_walks", "saved_lists", "saved_searches"})
                bindings.push_back({name, saved});
            bindings.push_back({"singles", singles});
            bindings.push_back({"unanswered", unanswered});
            run_chunks(about, kernel, bindings, push, 0, left.size(), 1);
            const std::vector<std::uint32_t> flags = unanswered.read<std::uint32_t>(part.size());
            for (const glm::uvec2& single : left)
                if (flags[single.y] == shared::TIES_UNCOUNTED)
                    uncounted.push_back(single.x);
            std::erase_if(left, [&](const glm::uvec2& single) { return flags[single.y] != 1; });
        }
    }
    return uncounted;
}

// Of queries one by one.
gpu::KernelSource name_selection(const Neighborhood& neighborhood, const Queries& queries,
                                 const RadiusSettings& settings, std::uint32_t capacity) {
    gpu::KernelSource kernel{"photons/select_radius.comp", 0, list_defines(neighborhood, queries), {capacity}};
    if (settings.leaves_self_out)
        kernel.defines.emplace_back("WITHOUT_SELF");
    kernel.defines.emplace_back("BY_ID");
    if (settings.cuts_ties)
        kernel.defines.emplace_back("CUT_TIES");
    return kernel;
}

void set_batches(std::span<std::byte> push, std::uint32_t batches) {
    shared::GatherSettings settings;
    std::memcpy(&settings, push.data(), sizeof settings);
    settings.batches = batches;
    std::memcpy(push.data(), &settings, sizeof settings);
}

} // namespace

void require_k(std::uint32_t k) {
    if (k < 1 || k > MOST_NEIGHBORS)
        throw Error("k is " + std::to_string(k) + "; it must be 1 to " + std::to_string(MOST_NEIGHBORS));
}

shared::GatherSettings make_gather_settings(const Neighborhood& neighborhood, std::uint32_t rank) {
    shared::GatherSettings settings{};
    const auto& period = neighborhood.period;
    settings.period = {period[0], period[1], period[2], 0.0f};
    settings.photon_count = static_cast<std::uint32_t>(neighborhood.tree.count);
    settings.leaf_level = neighborhood.tree.leaf_level;
    settings.rank = rank;
    settings.batches = BATCHES;
    settings.stride = 1;
    settings.flatness = neighborhood.flatness;
    return settings;
}

gpu::KernelSource name_radius_kernel(const Neighborhood& neighborhood, const Queries& queries,
                                     const RadiusSettings& settings) {
    gpu::KernelSource kernel{"photons/find_radii.comp", 0, list_defines(neighborhood, queries), {}};
    if (settings.leaves_self_out)
        kernel.defines.emplace_back("WITHOUT_SELF");
    if (settings.cuts_ties)
        kernel.defines.emplace_back("CUT_TIES");
    if (settings.leaves_self_out)
        kernel.defines.emplace_back("BY_ID");
    if (settings.is_carried)
        kernel.defines.emplace_back("CARRIED");
    const std::uint32_t shell = size_shell(settings.rank);
    kernel.defines.push_back("SHELL_SIZE " + std::to_string(shell) + "u");
    kernel.defines.push_back(write_each("EACH_KEPT", 0, shell));
    return kernel;
}

gpu::KernelSource name_gather_kernel(const Neighborhood& neighborhood, const Queries& queries,
                                     const GatherKernel& kernel) {
    gpu::KernelSource source{kernel.path, 0, list_defines(neighborhood, queries), {}};
    source.defines.insert(source.defines.end(), kernel.defines.begin(), kernel.defines.end());
    return source;
}

void find_radii(gpu::Device& device, const Neighborhood& neighborhood, const Queries& queries,
                const RadiusSettings& settings, const gpu::Buffer& radii, const std::string& stage,
                const Progress& progress) {
    if (neighborhood.tree.count == 0 || queries.count == 0)
        return;
    const Gathering about{device, neighborhood, queries, stage, progress};
    shared::GatherSettings push = make_gather_settings(neighborhood, settings.rank);
    push.includes_last = settings.includes_last ? 1 : 0;
    push.carry = settings.carry;
    push.stride = settings.stride;
    const std::span<std::byte> bytes = std::as_writable_bytes(std::span(&push, 1));
    const std::vector<std::uint32_t> left = run_side_by_side(about, name_radius_kernel(neighborhood, queries, settings),
                                                             {{"radii", radii}}, bytes, 0, queries.count, false);
    if (left.empty())
        return;
    set_batches(bytes, 1);
    const std::uint32_t capacity = size_list(settings.rank, device.limits().subgroup_size);
    const std::vector<std::uint32_t> uncounted =
        run_singly(about, name_selection(neighborhood, queries, settings, capacity), {{"radii", radii}}, bytes, left,
                   SAVED_SEARCH_HEAD + 4 * shared::TREE_STACK_SIZE + 3 * capacity);
    if (uncounted.empty() || !settings.needs_ties)
        return;
    std::vector<std::string> defines = list_defines(neighborhood, queries);
    defines.emplace_back("SINGLY");
    run_singly(about, {"photons/count_ties.comp", 0, defines, {}}, {{"radii", radii}}, bytes, uncounted,
               SAVED_WALK_WORDS);
}

std::vector<std::uint32_t> gather_once(gpu::Device& device, const Neighborhood& neighborhood, const Queries& queries,
                                       const GatherKernel& kernel, std::span<const std::byte> push,
                                       const std::string& stage, const Progress& progress) {
    const Gathering about{device, neighborhood, queries, stage, progress};
    return run_side_by_side(about, name_gather_kernel(neighborhood, queries, kernel), kernel.bindings, push, 0,
                            queries.count, kernel.takes_subgroups);
}

void run_gather(gpu::Device& device, const Neighborhood& neighborhood, const Queries& queries,
                const GatherKernel& kernel, std::span<const std::byte> push, std::uint64_t first, std::uint64_t count,
                const std::string& stage, const Progress& progress) {
    if (neighborhood.tree.count == 0 || count == 0)
        return;
    const Gathering about{device, neighborhood, queries, stage, progress};
    gpu::KernelSource source = name_gather_kernel(neighborhood, queries, kernel);
    const std::vector<std::uint32_t> left =
        run_side_by_side(about, source, kernel.bindings, push, first, count, kernel.takes_subgroups);
    if (left.empty())
        return;
    std::vector<std::byte> singly(push.begin(), push.end());
    set_batches(singly, 1);
    source.defines.emplace_back("SINGLY");
    run_singly(about, source, kernel.bindings, singly, left,
               kernel.saved_words ? kernel.saved_words : SAVED_WALK_WORDS);
}

} // namespace photonloupe
