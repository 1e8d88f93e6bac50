// SPDX-License-Identifier: Apache-2.0
// Finds what automatic settings of relaxation stand for.
#include "relax/settings.h"

#include <algorithm>
#include <cmath>

namespace photonloupe {
namespace {

constexpr std::uint32_t STEPS_OF_SOBOL = 5, STEPS_OF_RANDOM = 20;
constexpr std::uint32_t K_OF_SPLIT = 150, K_OF_OTHERS = 50;

// Axis ratio t that 5 % of uniform points stay below (METHODS §5.2); 1 - c/√k between them, with c linear in log k.
constexpr std::array<double, 4> ISOTROPY_K{20, 50, 100, 250};
constexpr std::array<double, 4> ISOTROPY_QUANTILES{0.61, 0.75, 0.82, 0.88};
constexpr double ISOTROPY_MARGIN = 0.05;
constexpr double ISOTROPY_SPAN = 0.3;
// Largest eigenvalue over that of noise; homogeneity of spacings (METHODS §5.3, §5.4).
constexpr std::array<double, 2> TENSOR_THRESHOLDS{2.0, 6.0};
constexpr std::array<double, 2> SPLIT_THRESHOLDS{0.35, 0.2};
// Edge of one-sidedness, fixed in the kernel (METHODS §5.2).
constexpr std::array<double, 2> GRADIENT_THRESHOLDS{0.35, 0.8};

std::array<double, 2> find_pca_thresholds(std::uint32_t k) {
    const auto find_factor = [](std::size_t i) { return (1.0 - ISOTROPY_QUANTILES[i]) * std::sqrt(ISOTROPY_K[i]); };
    const double clamped = std::clamp<double>(k, ISOTROPY_K.front(), ISOTROPY_K.back());
    std::size_t i = 0;
    while (i + 2 < ISOTROPY_K.size() && clamped > ISOTROPY_K[i + 1])
        ++i;
    const double share = std::log(clamped / ISOTROPY_K[i]) / std::log(ISOTROPY_K[i + 1] / ISOTROPY_K[i]);
    const double c = find_factor(i) + share * (find_factor(i + 1) - find_factor(i));
    const double free_at = 1.0 - c / std::sqrt(static_cast<double>(k)) + ISOTROPY_MARGIN;
    return {free_at, free_at - ISOTROPY_SPAN};
}

} // namespace

std::uint32_t choose_steps(std::optional<Emission> emission) {
    return emission == Emission::sobol ? STEPS_OF_SOBOL : STEPS_OF_RANDOM;
}

std::uint32_t choose_constraint_neighbors(Descriptor descriptor) {
    return descriptor == Descriptor::split ? K_OF_SPLIT : K_OF_OTHERS;
}

std::array<double, 2> choose_thresholds(Descriptor descriptor, std::uint32_t k) {
    switch (descriptor) {
    case Descriptor::pca:
        return find_pca_thresholds(k);
    case Descriptor::tensor:
        return TENSOR_THRESHOLDS;
    case Descriptor::split:
        return SPLIT_THRESHOLDS;
    default:
        return GRADIENT_THRESHOLDS;
    }
}

std::string describe_steps() {
    return std::to_string(STEPS_OF_SOBOL) + " for Sobol emission, " + std::to_string(STEPS_OF_RANDOM) + " for random";
}

std::string describe_constraint_neighbors() {
    return std::to_string(K_OF_OTHERS) + ", split " + std::to_string(K_OF_SPLIT);
}

RelaxSettings complete_settings(RelaxSettings settings, std::optional<Emission> emission, bool has_parameters) {
    if (!settings.steps)
        settings.steps = choose_steps(emission);
    if (!settings.constraint)
        settings.constraint = has_parameters ? Space::parameter : Space::world;
    if (!settings.constraint_neighbors)
        settings.constraint_neighbors = choose_constraint_neighbors(settings.descriptor);
    if (!settings.thresholds)
        settings.thresholds = choose_thresholds(settings.descriptor, *settings.constraint_neighbors);
    return settings;
}

} // namespace photonloupe
