// SPDX-License-Identifier: Apache-2.0
// What looking at the photons around a place can be told ([SJL15] section 4); the same names in Python.
#pragma once

#include <cstdint>

#include "photons/search_space.h"

namespace photonloupe::inspect {

struct LoupeSettings {
    std::uint32_t k = 250;
    SearchSpace space = SearchSpace::world;
    double beta = 3.0; // METHODS §4; relaxation has its own
    bool operator==(const LoupeSettings&) const = default;
};

template <class Rows>
void visit(Rows& row, LoupeSettings& s) {
    row(s.k, {.name = "k",
              .doc = "how many photons",
              .range = {1, MOST_NEIGHBORS},
              .usual = {1, MOST_NEIGHBORS},
              .is_logarithmic = true});
    row(s.space,
        {.name = "space",
         .doc = "nearest in the world (`world`), in parameter space (`parameter`), or in the world among those "
                "of a layer (`constrained`)",
         .choices = {"world", "parameter", "constrained"}});
    row(s.beta, {.name = "beta",
                 .doc = "β of the layer: photons within β times the distance to the k-th in parameter space",
                 .range = {0, 1e18},
                 .symbol = "β",
                 .usual = {0, 30}});
}

} // namespace photonloupe::inspect
