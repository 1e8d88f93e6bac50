// SPDX-License-Identifier: Apache-2.0
// How sums, least and greatest values over photons are combined: one order, for passes and for the interpreter.
//
// Photons are taken in blocks of 4,096 consecutive ids. In a block, lane l of 64 takes ids l, l + 64, l + 128 … in
// order, each adding to the lane's own value (which starts at the identity). The 64 lanes are combined pairwise: 0 with
// 1, 2 with 3 …, then those results pairwise, and so on; the blocks likewise (an odd one out moves up unchanged). At
// the end the value the variable had before the loop is combined with the total: before + total, min(before, total), …
#pragma once

#include <cstdint>
#include <span>

#include "script/number.h"
#include "script/plan/plan.h"
#include "shared/script.h"

namespace photonloupe::script {

constexpr std::uint32_t REDUCTION_BLOCK = shared::SCRIPT_BLOCK;
constexpr std::uint32_t REDUCTION_LANES = shared::SCRIPT_LANES;

Number find_identity(Role role, Type type);               // 0; +inf or INT_MAX; -inf or INT_MIN
Number combine(Role role, Type type, Number a, Number b); // sum, minimum, maximum

// A least or greatest with the photon that gave it: the strictly better value wins, equals go to the lower photon id.
struct Choice {
    Number value;
    std::uint32_t photon = 0xffffffffu; // none yet
};
bool wins(Role role, Type type, const Choice& challenger, const Choice& holder);

// Count, mean and centred moments of pushed points (Welford; merged after Chan et al.), in the order of photons.
struct Moments {
    std::int32_t count = 0;
    std::uint32_t first_photon = 0xffffffffu; // gave first_point: decides the eigenvectors' sign (METHODS §4)
    float first_point[3] = {};
    float mean[3] = {};
    float products[6] = {}; // xx xy xz yy yz zz, sums of products of deviations
};
void push_point(Moments& moments, std::span<const float> point, std::uint32_t photon);
Moments merge_moments(const Moments& a, const Moments& b);

// Largest eigenvalue first; divided by the number of points. False: fewer than two points, all equal, or not finite;
// there is no decomposition then.
struct Decomposition {
    std::int32_t dimensions = 0; // 0: none yet
    float eigenvalues[3] = {};
    float eigenvectors[3][3] = {};
    float mean[3] = {};
};
bool decompose_moments(const Moments& moments, std::int32_t dimensions, Decomposition& decomposition);

} // namespace photonloupe::script
