// SPDX-License-Identifier: Apache-2.0
// How often a column's values occur, which share lies below, and where a share ends.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "inspect/column.h"

namespace photonloupe::inspect {

struct ColumnHistogram {
    std::vector<double> edges;         // one more than bins, even
    std::vector<std::uint64_t> counts; // a bin holds its lower edge, the last one its upper edge too
    std::uint64_t below = 0, above = 0, non_finite = 0;
    std::vector<double> cdf; // share of the finite values up to each bin's upper edge
};

// `range`: by default the column's low and high. One without extent is widened by a half on both sides, as NumPy does.
// Throws Error for no bins, too many, or a range that is not finite or runs down.
ColumnHistogram count_column(const Column& column, std::uint32_t bins,
                             std::optional<std::pair<double, double>> range = {});

inline constexpr std::uint32_t MAX_BINS = 65536;

// The value that a share of the finite ones lie below, between neighbours linearly; NaN where none is finite.
double find_quantile(std::span<const float> values, double share);
// The same of finite ones, of which there are some; reorders them.
double find_quantile(std::vector<double>& finite, double share);

// Share of the finite values above a threshold; NaN where none is finite.
double find_share_above(std::span<const float> values, double threshold);

} // namespace photonloupe::inspect
