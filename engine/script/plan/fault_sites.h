// SPDX-License-Identifier: Apache-2.0
// What can go wrong while a script runs, and where: the run goes on with NaN (integers: 0), and the report says so.
#pragma once

#include <cstdint>

#include "script/read/source.h"

namespace photonloupe::script {

enum class Fault : std::uint8_t {
    unset_variable,  // read before it is set
    array_index,     // outside the array; a write is dropped
    list_index,      // outside the neighbour list
    photon_index,    // no such photon
    vertex_index,    // no such vertex on the photon's path
    axis_index,      // axis or channel outside 0–2
    dimension_index, // parameter that is not declared
    eigen_index,     // PCA eigenvalue that is not there, or nothing was decomposed
    not_integral,    // a float used as index, axis, photon or dimension has a fraction or is NaN
    modulo_by_zero,
    does_not_fit,    // int, floor, ceil, round of NaN, inf or beyond 32 bits
    no_value,        // a function ended without return
    declaration,     // a dimension that leaves a gap or is not 3–15, bounds that are not ascending or not finite
    query,           // k that no query takes, β that is negative or NaN
    histogram_range, // histogram whose bounds are not ascending or not finite, or whose bins are not 1–4096
};

// One place that can fault in one way. A pass keeps a list of them and reports, for each, the number of photons that
// met it and the first of them; the interpreter records the same pairs.
struct FaultSite {
    Fault kind = Fault::unset_variable;
    Span span; // of the expression that faults
};

} // namespace photonloupe::script
