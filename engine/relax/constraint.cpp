// SPDX-License-Identifier: Apache-2.0
// Drives the descriptor kernels.
#include "relax/constraint.h"

namespace photonloupe {
namespace {

std::vector<std::string> list_defines(const GatherShape& shape, const ConstraintSettings& settings) {
    std::vector<std::string> defines = list_gather_defines(shape, settings.neighbors);
    defines.push_back("DESCRIPTOR " + std::to_string(static_cast<std::uint32_t>(settings.descriptor)));
    return defines;
}

} // namespace

Constraint measure_constraint(gpu::Device& device, const KdTree& tree, const GatherShape& shape, const Layers& layers,
                              const ConstraintSettings& settings, const gpu::Buffer& radii, const Progress& progress) {
    const std::uint64_t bytes = tree.count * sizeof(glm::vec4);
    Constraint constraint{gpu::Buffer(device, bytes, "constraint basis"),
                          gpu::Buffer(device, bytes, "constraint basis"), gpu::Buffer(device, bytes, "gradients"),
                          gpu::Buffer(device, bytes, "constraint radii")};
    const gpu::Buffer& parameters = layers.parameters.is_empty() ? tree.positions : layers.parameters;
    const gpu::Buffer& reach2 = layers.reach2.is_empty() ? radii : layers.reach2;
    const gpu::Buffer& periods = layers.periods.is_empty() ? radii : layers.periods;
    const auto run = [&](const char* kernel, const auto& run_kernel) {
        run_kernel(
            device, tree, kernel, list_defines(shape, settings), make_gather_settings(tree, shape, settings.neighbors),
            "measure constraint",
            [&](gpu::Commands& commands, const gpu::KernelSource& source, const shared::GatherSettings& chunk,
                const GatherBuffers& buffers, std::uint64_t invocations) {
                const shared::DescribeSettings push{chunk, settings.free_at, settings.fixed_at, 0, 0};
                commands.dispatch(source,
                                  {{"tree_nodes", tree.nodes},
                                   {"tree_positions", tree.positions},
                                   {"tree_normals", tree.normals},
                                   {"tree_parameters", parameters},
                                   {"tree_ranges", layers.ranges ? *layers.ranges : tree.positions},
                                   {"parameter_reach", reach2},
                                   {"parameter_periods", periods},
                                   {"radii", radii},
                                   {"offsets", constraint.offsets},
                                   {"member_radii", constraint.member_radii},
                                   {"constraint_along", constraint.along},
                                   {"constraint_across", constraint.across},
                                   {"singles", buffers.singles},
                                   {"unanswered", buffers.unanswered}},
                                  push, invocations);
            },
            progress);
    };
    run("relax/measure_moments.comp", run_gather);
    if (settings.descriptor == Descriptor::tensor)
        run("relax/measure_tensor.comp", run_gather);
    if (settings.descriptor == Descriptor::split)
        run("relax/measure_split.comp", run_gather_singly);
    return constraint;
}

} // namespace photonloupe
