// SPDX-License-Identifier: Apache-2.0
// Writes random scripts that are right by construction: statements of all kinds around loops over photons.
#pragma once

#include <cstdint>
#include <string>

namespace photonloupe::script::tests {

// All numbers in it are whole and small, so that sums of floats are exact in any order. Loops over photons reduce
// (sums, extremes, choices, array elements), and now and then do what makes them serial.
std::string write_random_script(std::uint32_t seed);

} // namespace photonloupe::script::tests
