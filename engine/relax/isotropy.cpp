// SPDX-License-Identifier: Apache-2.0
// Drives the isotropy kernel.
#include "relax/isotropy.h"

#include <cmath>

namespace photonloupe {

std::vector<float> measure_isotropy(gpu::Device& device, const PhotonMap& photons, const ParameterTree& parameter_tree,
                                    std::uint32_t k, const Progress& progress) {
    const KdTree& tree = parameter_tree.tree;
    if (tree.count == 0)
        return {};
    const gpu::Buffer ratios(device, tree.count * sizeof(float), "axis ratios");
    shared::GatherSettings settings = make_gather_settings(tree, parameter_tree.shape, k);
    settings.flatness = parameter_tree.limit2;
    run_gather(
        device, tree, "relax/measure_isotropy.comp", list_gather_defines(parameter_tree.shape, k), settings,
        "measure isotropy",
        [&](gpu::Commands& commands, const gpu::KernelSource& kernel, const shared::GatherSettings& push,
            const GatherBuffers& buffers, std::uint64_t invocations) {
            commands.dispatch(kernel,
                              {{"tree_nodes", tree.nodes},
                               {"tree_positions", tree.positions},
                               {"tree_normals", tree.normals},
                               {"tree_parameters", parameter_tree.parameters},
                               {"parameter_periods", parameter_tree.periods},
                               {"position_emitter", photons.position_emitter},
                               {"normal_index", photons.normal_index},
                               {"axis_ratios", ratios},
                               {"singles", buffers.singles},
                               {"unanswered", buffers.unanswered}},
                              push, invocations);
        },
        progress);
    return ratios.read<float>(tree.count);
}

} // namespace photonloupe
