// SPDX-License-Identifier: Apache-2.0
// Photons within a polygon that was drawn over a scatter plot.
#pragma once

#include <span>

#include "inspect/scatter.h"

namespace photonloupe::inspect {

// Ids whose place in the plot lies inside, by the even-odd rule; `polygon` is in pixels and closes itself.
Selection find_in_lasso(const Column& x, const Column& y, const ScatterFrame& frame,
                        std::span<const glm::dvec2> polygon);

} // namespace photonloupe::inspect
