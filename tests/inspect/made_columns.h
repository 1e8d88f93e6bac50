// SPDX-License-Identifier: Apache-2.0
// Columns made up for the tests of parallel coordinates.
#pragma once

#include <random>

#include "inspect/parallel_curves.h"

namespace photonloupe::test {

inline inspect::Column make_column(std::vector<float> values, float low = 0, float high = 1) {
    return {.name = "c", .label = "c", .values = std::move(values), .low = low, .high = high};
}

// Uniform values between 0 and 1.
inline std::vector<inspect::Column> make_columns(std::size_t axis_count, std::size_t photon_count,
                                                 std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform;
    std::vector<inspect::Column> columns;
    for (std::size_t a = 0; a < axis_count; ++a) {
        std::vector<float> values(photon_count);
        for (float& value : values)
            value = uniform(random);
        columns.push_back(make_column(std::move(values)));
    }
    return columns;
}

inline std::vector<inspect::Axis> make_axes(const std::vector<inspect::Column>& columns) {
    std::vector<inspect::Axis> axes;
    for (std::size_t i = 0; i < columns.size(); ++i)
        axes.push_back(inspect::make_axis(columns, i));
    return axes;
}

// Height of a curve above x, which lies in the gap.
inline float find_height(const inspect::Curves& curves, std::size_t curve, std::size_t gap, float x) {
    const auto [from, from_handle, to_handle, to] = find_bezier(curves, curve, gap);
    const float t = (x - from.x) / (to.x - from.x), s = 1 - t;
    return s * s * (s * from.y + 3 * t * from_handle.y) + t * t * (3 * s * to_handle.y + t * to.y);
}

} // namespace photonloupe::test
