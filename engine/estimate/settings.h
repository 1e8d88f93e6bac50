// SPDX-License-Identifier: Apache-2.0
// What estimates of irradiance and pictures can be told (METHODS §2); the same names in Python.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "photons/search_space.h"
#include "shared/photons.h"
#include "trace/settings.h"

namespace photonloupe {

enum class DensityKernel : std::uint32_t {
    epanechnikov = shared::KERNEL_EPANECHNIKOV,
    disc = shared::KERNEL_DISC,
    cone = shared::KERNEL_CONE,
    gaussian = shared::KERNEL_GAUSSIAN,
};

enum class RenderMode : std::uint32_t { composite, caustic, direct, photons, false_color, voronoi };

struct EstimateSettings {
    std::optional<std::uint32_t> k;
    DensityKernel kernel = DensityKernel::epanechnikov;
    bool operator==(const EstimateSettings&) const = default;
};

struct RenderSettings {
    std::uint32_t width = 512;
    std::uint32_t height = 512;
    std::uint32_t samples = 4;
    RenderMode mode = RenderMode::composite;
    EstimateSettings estimate;
    std::uint32_t seed = 1;
    std::uint32_t max_bounces = 16;
    bool operator==(const RenderSettings&) const = default;
};

// Best k of the unrelaxed ring caustic, 200,000 photons (METHODS §7); of photons that came from elsewhere that of the
// noisiest.
inline constexpr std::uint32_t K_OF_SOBOL = 50, K_OF_RANDOM = 100;

constexpr std::uint32_t choose_k(const EstimateSettings& settings, std::optional<Emission> emission = {}) {
    return settings.k.value_or(emission == Emission::sobol ? K_OF_SOBOL : K_OF_RANDOM);
}

inline EstimateSettings complete_settings(EstimateSettings settings, std::optional<Emission> emission) {
    settings.k = choose_k(settings, emission);
    return settings;
}

inline constexpr std::uint32_t LARGEST_SIDE = 16'384; // pixels of a picture that is made
inline constexpr std::uint32_t MOST_SAMPLES = 4096;   // of a pixel

template <class Rows>
void visit(Rows& row, EstimateSettings& s) {
    row(s.k, {.name = "k",
              .doc = "how many photons an estimate gathers",
              .range = {1, MOST_NEIGHBORS},
              .empty = "auto",
              .automatic =
                  std::to_string(K_OF_SOBOL) + " for Sobol emission, " + std::to_string(K_OF_RANDOM) + " for random",
              .usual = {4, 500},
              .is_logarithmic = true});
    row(s.kernel, {.name = "kernel",
                   .doc = "how photons are weighed over the distance",
                   .choices = {"epanechnikov", "disc", "cone", "gaussian"}});
}

template <class Rows>
void visit(Rows& row, RenderSettings& s) {
    row(s.width, {.name = "width", .doc = "of the picture", .range = {1, LARGEST_SIDE}, .unit = "pixels"});
    row(s.height, {.name = "height",
                   .doc = "of the picture; the camera's vertical angle is kept whatever the aspect",
                   .range = {1, LARGEST_SIDE},
                   .unit = "pixels"});
    row(s.samples, {.name = "samples",
                    .doc = "per pixel, box filter",
                    .range = {1, MOST_SAMPLES},
                    .usual = {1, 64},
                    .is_logarithmic = true});
    row(s.mode,
        {.name = "mode",
         .doc = "`composite`: emission, direct light where the map has none, and the map; `caustic`: the map alone; "
                "`direct`: emission and direct light; `photons`: the stored photons as dots; `false-color`: the mean "
                "color of the photons around times the luminance of their irradiance; `voronoi`: the cells of the "
                "photons on the surfaces seen",
         .choices = {"composite", "caustic", "direct", "photons", "false-color", "voronoi"}});
    visit(row, s.estimate);
    row(s.max_bounces, {.name = "max_bounces",
                        .doc = "how many mirrors and panes a look into the scene goes on after",
                        .range = {0, MOST_BOUNCES},
                        .usual = {0, MOST_BOUNCES}});
    row(s.seed, {.name = "seed", .doc = "of the samples within the pixel", .range = {0, LARGEST_SEED}});
}

} // namespace photonloupe
