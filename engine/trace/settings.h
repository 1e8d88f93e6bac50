// SPDX-License-Identifier: Apache-2.0
// What tracing can be told (METHODS §1); the same names in Python.
#pragma once

#include <cstdint>
#include <optional>

#include "shared/trace.h"

namespace photonloupe {

enum class Emission : std::uint32_t { sobol = shared::EMISSION_SOBOL, random = shared::EMISSION_RANDOM };
enum class Store : std::uint32_t {
    caustic = shared::STORE_CAUSTIC,
    indirect = shared::STORE_INDIRECT,
    all = shared::STORE_ALL,
};

inline constexpr std::uint64_t MOST_PHOTONS = (1ull << 31) - 1;
inline constexpr std::uint64_t MOST_EMITTED = 1ull << 30; // where tracing gives up on a scene that stores nothing, too
inline constexpr std::uint32_t MOST_BOUNCES = 64;
inline constexpr std::uint32_t LARGEST_SEED = UINT32_MAX;

struct TraceSettings {
    std::uint64_t count = 200'000;
    std::optional<std::uint64_t> emitted;
    std::uint32_t seed = 1;
    Emission emission = Emission::sobol;
    Store store = Store::caustic;
    std::uint32_t max_bounces = 16; // interactions before the storage point
    bool paths = false;             // record path columns
    bool operator==(const TraceSettings&) const = default;
};

template <class Rows>
void visit(Rows& row, TraceSettings& s) {
    row(s.count,
        {.name = "count",
         .doc = "least number of stored photons; they are emitted in whole blocks of 4,096 until it is reached",
         .range = {1, MOST_PHOTONS},
         .alias = "photons"});
    row(s.emitted, {.name = "emitted",
                    .doc = "number of photons to emit instead, whatever is stored",
                    .range = {1, MOST_EMITTED},
                    .empty = "none"});
    row(s.seed, {.name = "seed",
                 .doc = "every random number is a function of it, the emitted index, the bounce and the dimension",
                 .range = {0, LARGEST_SEED}});
    row(s.emission, {.name = "emission",
                     .doc = "how directions are drawn; `sobol`, Owen-scrambled, is worth about four times the photons "
                            "of `random` on a smooth caustic",
                     .choices = {"sobol", "random"}});
    row(s.store, {.name = "store",
                  .doc = "`caustic`: light that only mirrors and glass touched, L S+ D; `indirect`: any bounce; `all`: "
                         "direct light too",
                  .choices = {"caustic", "indirect", "all"}});
    row(s.max_bounces, {.name = "max_bounces",
                        .doc = "longest path; what is cut off is reported as truncated",
                        .range = {1, MOST_BOUNCES},
                        .usual = {1, MOST_BOUNCES}});
}

} // namespace photonloupe
