// SPDX-License-Identifier: Apache-2.0
// Specialises and dispatches the gathering kernels.
#include "photons/gather.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "photons/query_tree.h"
#include "photons/same_surface.h"

namespace photonloupe {
namespace {

// Photons kept in order above the bound (shaders/photons/find_radius.glsl). Each costs two operations for every
// photon that streams by, a bound that misses costs a pass.
constexpr std::uint32_t SMALLEST_SHELL = 4;
constexpr std::uint32_t LARGEST_SHELL = 12;
// Workgroups of the first chunk of work: fewer would leave the device idle while chunks grow.
constexpr std::uint64_t FIRST_GROUPS = 64;
// Subgroups of photons a workgroup takes in turn: amortises its start.
constexpr std::uint32_t BATCHES = 4;
constexpr std::array<const char*, 3> PLANES{"yz", "xz", "xy"}; // without axis 0, 1, 2

// Entries of the shell: all that are sought where that is few.
std::uint32_t size_shell(std::uint32_t k) {
    return std::clamp(k + 2, SMALLEST_SHELL, LARGEST_SHELL);
}

// A macro that calls its argument with 0 … count - 1: loops would count against the device's limit of turns.
std::string write_each(const std::string& name, std::uint32_t count) {
    std::string text = name + "(DO)";
    for (std::uint32_t i = 0; i < count; ++i)
        text += " DO(" + std::to_string(i) + ")";
    return text;
}

} // namespace

std::string find_flat_axes(const KdTree& tree) {
    if (tree.count == 0)
        return "";
    const std::vector<glm::vec4> positions = tree.positions.read<glm::vec4>(tree.count);
    const std::vector<glm::vec4> normals = tree.normals.read<glm::vec4>(tree.count);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        glm::vec3 along(0.0f);
        along[axis] = normals[0][axis];
        if (std::abs(along[axis]) != 1.0f)
            continue;
        for (std::size_t i = 0; i < positions.size(); ++i)
            if (glm::vec3(normals[i]) != along || positions[i][axis] != positions[0][axis])
                return "";
        return PLANES[axis];
    }
    return "";
}

std::vector<std::string> list_parameter_defines(const GatherShape& shape) {
    if (shape.parameter_count == 0)
        return {};
    std::vector<std::string> defines{"PARAMETER_COUNT " + std::to_string(shape.parameter_count) + "u",
                                     "PARAMETER_ROWS " + std::to_string((shape.parameter_count + 3) / 4) + "u",
                                     write_each("EACH_PARAMETER", shape.parameter_count)};
    if (shape.has_periodic_parameters)
        defines.emplace_back("PERIODIC_PARAMETERS");
    if (!shape.range_axes.empty()) {
        std::string axes = "TREE_RANGES uint[3](";
        for (std::size_t i = 0; i < 3; ++i)
            axes += (i ? ", " : "") + std::to_string(i < shape.range_axes.size() ? shape.range_axes[i] : 255) + "u";
        defines.push_back(axes + ")");
    }
    return defines;
}

std::vector<std::string> list_gather_defines(const GatherShape& shape, std::uint32_t k) {
    const std::uint32_t size = size_shell(k);
    std::vector<std::string> defines{"SHELL_SIZE " + std::to_string(size) + "u", write_each("EACH_KEPT", size)};
    if (!shape.flat_axes.empty())
        defines.push_back("FLAT_AXES " + shape.flat_axes);
    if (shape.period != std::array<float, 3>{})
        defines.emplace_back("PERIODIC");
    for (std::string& define : list_parameter_defines(shape))
        defines.push_back(std::move(define));
    return defines;
}

shared::GatherSettings make_gather_settings(const KdTree& tree, const GatherShape& shape, std::uint32_t k) {
    shared::GatherSettings settings{};
    settings.period = {shape.period[0], shape.period[1], shape.period[2], 0.0f};
    settings.photon_count = static_cast<std::uint32_t>(tree.count);
    settings.leaf_level = tree.leaf_level;
    settings.k = k;
    settings.flatness = SURFACE_FLATNESS;
    return settings;
}

namespace {

// One way to run a kernel: how many photons, how many of them a workgroup of one subgroup takes, and flags for them.
struct GatherRun {
    gpu::KernelSource kernel;
    std::uint64_t total;
    std::uint64_t per_group;
    std::uint64_t flag_count;
};

// Runs it; returns the flags, set where photons were left unanswered.
std::vector<std::uint32_t> gather_once(gpu::Device& device, const GatherRun& run, const gpu::Buffer& singles,
                                       shared::GatherSettings settings, const std::string& stage,
                                       const GatherDispatch& dispatch, const Progress& progress) {
    const std::uint32_t width = device.limits().subgroup_size;
    // All flags are set: a workgroup that the device stops for its loop turns clears none.
    const gpu::Buffer unanswered =
        gpu::make_buffer(device, std::vector<std::uint32_t>(run.flag_count, 1), "unanswered");
    gpu::run_in_chunks(
        device, stage, run.total, run.per_group * FIRST_GROUPS, progress,
        [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
            settings.first = static_cast<std::uint32_t>(first);
            settings.count = static_cast<std::uint32_t>(count);
            dispatch(commands, run.kernel, settings, {singles, unanswered},
                     (count + run.per_group - 1) / run.per_group * width);
        },
        run.per_group * device.limits().max_group_count);
    return unanswered.read<std::uint32_t>(run.flag_count);
}

bool has_flag(const std::vector<std::uint32_t>& flags) {
    return std::any_of(flags.begin(), flags.end(), [](std::uint32_t flag) { return flag != 0; });
}

// Photons of the runs that are flagged.
std::vector<std::uint32_t> list_flagged(const std::vector<std::uint32_t>& flags, std::uint32_t width,
                                        std::uint64_t photon_count) {
    std::vector<std::uint32_t> photons;
    for (std::size_t run = 0; run < flags.size(); ++run)
        for (std::uint64_t at = run * width; flags[run] && at < std::min(photon_count, (run + 1) * width); ++at)
            photons.push_back(static_cast<std::uint32_t>(at));
    return photons;
}

// Runs the kernel side by side; photons of the runs that were left unanswered.
std::vector<std::uint32_t> find_unanswered(gpu::Device& device, const KdTree& tree, const gpu::KernelSource& kernel,
                                           shared::GatherSettings settings, const std::string& stage,
                                           const GatherDispatch& dispatch, const Progress& progress) {
    const std::uint32_t width = device.limits().subgroup_size;
    settings.batches = BATCHES;
    const gpu::Buffer none = gpu::make_buffer(device, std::vector<std::uint32_t>{0}, "single photons");
    return list_flagged(
        gather_once(device, {kernel, tree.count, std::uint64_t{width} * BATCHES, (tree.count + width - 1) / width},
                    none, settings, stage, dispatch, progress),
        width, tree.count);
}

[[noreturn]] void refuse_crowd(const std::string& stage) {
    throw CrowdError(stage + ": some photons reach more of the map than one workgroup can look through; are very many "
                             "photons in one place, or of one layer spread over all of a large map?");
}

} // namespace

bool try_gather(gpu::Device& device, const KdTree& tree, const std::string& kernel,
                const std::vector<std::string>& defines, const shared::GatherSettings& settings,
                const std::string& stage, const GatherDispatch& dispatch, const Progress& progress) {
    if (tree.count == 0)
        return true;
    const std::vector<std::uint32_t> left =
        find_unanswered(device, tree, {kernel, 0, defines, {}}, settings, stage, dispatch, progress);
    if (left.empty())
        return true;
    std::vector<std::string> singly = defines;
    singly.emplace_back("SINGLY");
    const gpu::Buffer singles = gpu::make_buffer(device, left, "single photons");
    return !has_flag(gather_once(device, {{kernel, 0, singly, {}}, left.size(), 1, left.size()}, singles, settings,
                                 stage, dispatch, progress));
}

void run_gather(gpu::Device& device, const KdTree& tree, const std::string& kernel,
                const std::vector<std::string>& defines, const shared::GatherSettings& settings,
                const std::string& stage, const GatherDispatch& dispatch, const Progress& progress) {
    if (!try_gather(device, tree, kernel, defines, settings, stage, dispatch, progress))
        refuse_crowd(stage);
}

void run_gather_singly(gpu::Device& device, const KdTree& tree, const std::string& kernel,
                       const std::vector<std::string>& defines, const shared::GatherSettings& settings,
                       const std::string& stage, const GatherDispatch& dispatch, const Progress& progress) {
    if (tree.count == 0)
        return;
    const gpu::Buffer none = gpu::make_buffer(device, std::vector<std::uint32_t>{0}, "single photons");
    if (has_flag(gather_once(device, {{kernel, 0, defines, {}}, tree.count, 1, tree.count}, none, settings, stage,
                             dispatch, progress)))
        refuse_crowd(stage);
}

} // namespace photonloupe
