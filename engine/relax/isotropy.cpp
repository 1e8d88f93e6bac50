// SPDX-License-Identifier: Apache-2.0
// Drives the isotropy kernel.
#include "relax/isotropy.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.h"

namespace photonloupe {
namespace {

// Linear between the two values around it.
double find_quantile(std::vector<float> values, double share) {
    std::sort(values.begin(), values.end());
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return std::lerp(static_cast<double>(values[below]), static_cast<double>(values[above]),
                     place - static_cast<double>(below));
}

} // namespace

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

std::optional<OptimalBeta> find_optimal_beta(gpu::Device& device, IndexedMap& photons, std::uint32_t k, double clip,
                                             const Progress& progress) {
    if (!photons.map.parameters)
        throw ArgumentError("optimal_beta needs parameters; set_parameters() or a script sets them");
    OptimalBeta found{measure_isotropy(device, *find_parameter_tree(device, photons, progress), k, progress)};
    std::vector<float> known = found.isotropy;
    std::erase_if(known, [](float ratio) { return std::isnan(ratio); });
    if (known.empty())
        return std::nullopt;
    found.threshold = find_quantile(std::move(known), clip);
    if (found.threshold <= 0) {
        std::ostringstream text;
        text << "a share " << clip << " of the photons has axis ratio 0: no β is large enough";
        throw ArgumentError(text.str());
    }
    found.beta = std::sqrt(1.0 / found.threshold);
    return found;
}

std::string explain_no_ratio(const PhotonMap& photons) {
    std::string names;
    for (const ParameterAxis& axis : photons.parameters->axes)
        names += (names.empty() ? "'" : ", '") + axis.name + "'";
    return "no photon has an axis ratio: by " + names +
           " more than k photons are alike, or none has parameters, or all are in one place; then every β gives the "
           "same layers, so give a number, or parameters that differ";
}

} // namespace photonloupe
