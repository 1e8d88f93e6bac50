// SPDX-License-Identifier: Apache-2.0
// Drives the isotropy kernel.
#include "relax/isotropy.h"

namespace photonloupe {

std::vector<float> measure_isotropy(gpu::Device& device, const ParameterTree& tree, std::uint32_t k,
                                    const Progress& progress) {
    constexpr const char* STAGE = "measure isotropy";
    const std::uint64_t count = tree.tree.count;
    if (count == 0)
        return {};
    const Neighborhood neighborhood = look_in(tree, Measure::parameters);
    const Queries queries = ask_photons(tree.tree);
    const gpu::Buffer radii(device, count * RADIUS_BYTES, "radii in parameter space");
    find_radii(device, neighborhood, queries, {rank_for(k)}, radii, STAGE, progress);
    const gpu::Buffer ratios(device, count * sizeof(float), "axis ratios");
    const GatherKernel kernel{"relax/measure_isotropy.comp", {}, {{"radii", radii}, {"axis_ratios", ratios}}};
    gather(device, neighborhood, queries, kernel, make_gather_settings(neighborhood, rank_for(k)), STAGE, progress);
    return ratios.read<float>(count);
}

} // namespace photonloupe
