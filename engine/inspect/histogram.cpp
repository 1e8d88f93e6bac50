// SPDX-License-Identifier: Apache-2.0
// Counts in double precision, with the edges deciding.
#include "inspect/histogram.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace photonloupe::inspect {
namespace {

constexpr double UNDEFINED = std::numeric_limits<double>::quiet_NaN();

std::pair<double, double> choose_range(const Column& column, std::optional<std::pair<double, double>> given) {
    auto [low, high] = given.value_or(std::pair<double, double>{column.low, column.high});
    if (!std::isfinite(low) || !std::isfinite(high) || low > high)
        throw Error("histogram: the range must be two finite numbers, the lower one first");
    if (low == high) {
        low -= 0.5;
        high += 0.5;
    }
    return {low, high};
}

std::vector<double> space_edges(double low, double high, std::uint32_t bins) {
    std::vector<double> edges(bins + 1);
    const double step = (high - low) / bins;
    for (std::uint32_t i = 0; i < bins; ++i)
        edges[i] = low + i * step;
    edges[bins] = high;
    return edges;
}

// The bin of a value within the range: the product may round past an edge.
std::size_t find_bin(const std::vector<double>& edges, double value) {
    const std::size_t bins = edges.size() - 1;
    const double share = (value - edges.front()) / (edges.back() - edges.front());
    std::size_t bin = std::min(static_cast<std::size_t>(share * static_cast<double>(bins)), bins - 1);
    while (bin > 0 && value < edges[bin])
        --bin;
    while (bin + 1 < bins && value >= edges[bin + 1])
        ++bin;
    return bin;
}

} // namespace

ColumnHistogram count_column(const Column& column, std::uint32_t bins, std::optional<std::pair<double, double>> range) {
    if (bins < 1 || bins > MAX_BINS)
        throw Error("histogram: bins is " + std::to_string(bins) + "; it must be 1 to " + std::to_string(MAX_BINS));
    const auto [low, high] = choose_range(column, range);
    ColumnHistogram histogram{space_edges(low, high, bins), std::vector<std::uint64_t>(bins), 0, 0, 0, {}};
    for (const float value : column.values)
        if (!std::isfinite(value))
            ++histogram.non_finite;
        else if (value < low)
            ++histogram.below;
        else if (value > high)
            ++histogram.above;
        else
            ++histogram.counts[find_bin(histogram.edges, value)];
    const double finite = static_cast<double>(column.values.size() - histogram.non_finite);
    std::uint64_t sum = histogram.below;
    for (const std::uint64_t count : histogram.counts)
        histogram.cdf.push_back(finite > 0 ? static_cast<double>(sum += count) / finite : 0.0);
    return histogram;
}

double find_quantile(std::vector<double>& finite, double share) {
    const double rank = share * static_cast<double>(finite.size() - 1);
    const auto below = finite.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(finite.begin(), below, finite.end());
    const double low = *below, rest = rank - std::floor(rank);
    return rest > 0 ? low + rest * (*std::min_element(below + 1, finite.end()) - low) : low;
}

double find_quantile(std::span<const float> values, double share) {
    std::vector<double> finite;
    std::copy_if(values.begin(), values.end(), std::back_inserter(finite), [](float v) { return std::isfinite(v); });
    return finite.empty() || !(share >= 0 && share <= 1) ? UNDEFINED : find_quantile(finite, share);
}

double find_share_above(std::span<const float> values, double threshold) {
    std::uint64_t finite = 0, above = 0;
    for (const float value : values) {
        finite += std::isfinite(value);
        above += std::isfinite(value) && value > threshold;
    }
    return finite ? static_cast<double>(above) / static_cast<double>(finite) : UNDEFINED;
}

} // namespace photonloupe::inspect
