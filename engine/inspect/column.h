// SPDX-License-Identifier: Apache-2.0
// One number per photon, as views plot it: its values, name, range, and whether it wraps or counts.
#pragma once

#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

namespace photonloupe::inspect {

struct Column {
    std::string name;          // as users type it: "x", "theta", "signature"
    std::string label;         // as axes show it, with its unit: "x [m]"
    std::vector<float> values; // by photon id; NaN: the photon has none
    float low = 0, high = 0;   // of its finite values, or the bounds that were declared
    float period = 0;          // after which it repeats; 0: it does not
    bool is_discrete = false;  // few distinct values: counted, not smoothed
};

// What is chosen: photon ids, ascending. Views show everything when there is no selection.
using Selection = std::vector<std::uint32_t>;

inline Selection select_all(std::size_t count) {
    Selection all(count);
    std::iota(all.begin(), all.end(), 0u);
    return all;
}

} // namespace photonloupe::inspect
