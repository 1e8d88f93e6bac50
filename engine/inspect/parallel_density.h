// SPDX-License-Identifier: Apache-2.0
// How many photons lie at each place of an axis: smooth, or bars where values are few ([SJL15] section 4.4).
#pragma once

#include "inspect/parallel_axes.h"

namespace photonloupe::inspect {

// Along an axis, relative to the densest place.
struct AxisDensity {
    std::vector<float> shares;  // places between the ends, ascending; of bars their middles
    std::vector<float> heights; // 0 to 1
    bool has_bars = false;      // of a discrete column: a bar for every distinct value between the ends
    float bandwidth = 0;        // standard deviation of the kernel, in the column's unit; bars: 0
    float peak = 0;             // what height 1 stands for: share of the values per unit, bars: number of values
};

constexpr std::size_t DENSITY_SAMPLES = 257;

// Gaussian kernel with Silverman's bandwidth 0.9 min(σ, IQR/1.34) n^(-1/5), σ alone where the IQR is 0, and no
// narrower than the distance between samples. On a closed axis it wraps over one turn, and σ and IQR are those of the
// values about their circular mean. Photons without a value do not count; without any value, all heights are 0.
AxisDensity estimate_density(const Column& column, const Axis& axis, const Selection& photons);

// The area between an axis and its density, at most `width` pixels deep: to the right of a line, outside an ellipse.
// A polygon, or four corners for each bar.
std::vector<std::vector<glm::vec2>> outline_density(const Axis& axis, const AxisPlace& place,
                                                    const AxisDensity& density, float width);

} // namespace photonloupe::inspect
