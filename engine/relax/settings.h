// SPDX-License-Identifier: Apache-2.0
// What relaxation can be told (METHODS §3–5); the same names in Python. The defaults have the least error of all that
// was measured on the ring (docs/relaxation.md).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "photons/search_space.h"
#include "shared/relax.h"
#include "trace/settings.h"

namespace photonloupe {

enum class Descriptor : std::uint32_t {
    none = shared::DESCRIPTOR_NONE,
    gradient = shared::DESCRIPTOR_GRADIENT,
    pca = shared::DESCRIPTOR_PCA,
    tensor = shared::DESCRIPTOR_TENSOR,
    split = shared::DESCRIPTOR_SPLIT,
};

// Which photons count as neighbours.
enum class Space : std::uint32_t {
    world,     // all
    parameter, // those of the same layer: |q_j - q_i| ≤ β·r_q(i), same emitter
};

enum class RadiusSearch : std::uint32_t { exact, carried };
enum class SurfaceChoice : std::uint32_t { automatic, tangent };

struct RelaxSettings {
    std::optional<std::uint32_t> steps;
    std::uint32_t neighbors = 20;
    std::optional<Space> constraint;
    Descriptor descriptor = Descriptor::tensor;
    std::optional<double> beta = 10.0; // empty: measured, before `complete_settings`
    Space repel = Space::world;
    std::array<double, 2> over_relaxation{1.0, 1.0}; // λmax, λmin
    std::optional<double> limit = 0.3;
    std::optional<std::uint32_t> constraint_neighbors;
    std::optional<std::array<double, 2>> thresholds; // leaves free, fixes
    bool diffuse_flux = false;
    RadiusSearch search = RadiusSearch::exact;
    SurfaceChoice surface = SurfaceChoice::automatic;
    std::array<double, 3> period{};
    bool constrains() const { return descriptor != Descriptor::none; }
    // Whether constraint or repulsion look at layers, once the settings are complete.
    bool uses_layers() const { return repel == Space::parameter || (constrains() && constraint == Space::parameter); }
    bool operator==(const RelaxSettings&) const = default;
};

// What automatic settings stand for.
std::uint32_t choose_steps(std::optional<Emission> emission); // of photons that came from elsewhere: none
std::uint32_t choose_constraint_neighbors(Descriptor descriptor);
std::array<double, 2> choose_thresholds(Descriptor descriptor, std::uint32_t k);
std::string describe_steps();
std::string describe_constraint_neighbors();

// The same with what is automatic filled in, but for β.
RelaxSettings complete_settings(RelaxSettings settings, std::optional<Emission> emission, bool has_parameters);

// Fewer photons say nothing about a neighbourhood (METHODS §5.2).
inline constexpr std::uint32_t FEWEST_CONSTRAINT_NEIGHBORS = 12;
inline constexpr std::uint32_t MOST_STEPS = 10'000;

template <class Rows>
void visit(Rows& row, RelaxSettings& s) {
    row(s.steps, {.name = "steps",
                  .doc = "S of eq. 2: noise against blur, for photons never settle, they go on flattening; 0 measures "
                         "the constraint only",
                  .range = {0, MOST_STEPS},
                  .empty = "auto",
                  .automatic = describe_steps(),
                  .usual = {1, 100}});
    row(s.neighbors, {.name = "neighbors",
                      .doc = "K of eq. 1: how many photons push one; more is a smoother push",
                      .range = {1, MOST_OTHERS},
                      .symbol = "K",
                      .usual = {1, 100},
                      .is_logarithmic = true});
    row(s.constraint, {.name = "constraint",
                       .doc = "which photons say where one may go: all around it (`world`), or those of its layer, "
                              "which left the light in like directions (`parameter`)",
                       .choices = {"world", "parameter"},
                       .empty = "auto",
                       .automatic = "parameter where the map has parameters, else world"});
    row(s.descriptor,
        {.name = "descriptor",
         .doc = "what the constraint looks at: the shape of the k photons around (`pca`), the direction in which "
                "neighbors agree that density changes (`tensor`), a gap in the density across the photon (`split`), "
                "one-sidedness alone (`gradient`), or nothing (`none`)",
         .choices = {"none", "gradient", "pca", "tensor", "split"}});
    row(s.beta, {.name = "beta",
                 .doc = "β: a layer is the photons within β times the distance to the k-th in parameter space",
                 .range = {0, 1e18},
                 .empty = "auto",
                 .automatic = "found from the map as by `optimal_beta` ([SJL15] eq. 6)",
                 .symbol = "β",
                 .usual = {0, 30}});
    row(s.repel, {.name = "repel",
                  .doc = "whether all photons push one (`world`), or those of its layer (`parameter`), which keeps "
                         "faint edges inside bright light",
                  .choices = {"world", "parameter"}});
    row(s.over_relaxation, {.name = "over_relaxation",
                            .doc = "λ of the first and of the last step; (2, 1.2) is [SJ09]'s and gives the evenest "
                                   "photons, 1 stays nearer to where they were",
                            .range = {1e-3, 1e3},
                            .symbol = "λ",
                            .usual = {0.1, 4},
                            .spreads = true});
    row(s.limit, {.name = "limit",
                  .doc = "ρ of the migration limiter, eq. 5",
                  .range = {1e-6, 1e6},
                  .empty = "none",
                  .symbol = "ρ",
                  .usual = {0.01, 2}});
    row(s.constraint_neighbors, {.name = "constraint_neighbors",
                                 .doc = "k of the descriptor",
                                 .range = {FEWEST_CONSTRAINT_NEIGHBORS, MOST_OTHERS},
                                 .empty = "auto",
                                 .automatic = describe_constraint_neighbors(),
                                 .symbol = "k",
                                 .usual = {FEWEST_CONSTRAINT_NEIGHBORS, 400},
                                 .is_logarithmic = true});
    row(s.thresholds, {.name = "thresholds",
                       .doc = "value of the descriptor that leaves a photon free, and the one that fixes it across",
                       .range = {-1e30, 1e30},
                       .empty = "auto",
                       .automatic = "the descriptor's own",
                       .differs = true});
    row(s.diffuse_flux, {.name = "diffuse_flux", .doc = "let fluxes even out too; the total is kept"});
    row(s.search, {.name = "search",
                   .doc = "radii of every step (`exact`), or those of the step before, corrected by the number of "
                          "photons within (`carried`): faster",
                   .choices = {"exact", "carried"}});
    row(s.surface, {.name = "surface",
                    .doc = "whether photons return to the scene's surface (`auto`) or move in their tangent planes "
                           "(`tangent`)",
                    .choices = {"auto", "tangent"}});
    row(s.period, {.name = "period",
                   .doc = "lengths after which space repeats along x, y and z, 0 where it does not",
                   .range = {0, 1e30},
                   .unit = "m"});
}

} // namespace photonloupe
