// SPDX-License-Identifier: Apache-2.0
// Deviations over a sample, by medians.
#include "relax/measure_evenness.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace photonloupe {
namespace {

constexpr std::uint32_t FEW = 20, MANY = 100; // of the noisy and of the smooth estimate
constexpr std::size_t FEWEST_PHOTONS = 2 * MANY;
constexpr double DEVIATION = 1.4826; // standard deviation of a normal distribution over the median absolute deviation

double find_median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return values.size() % 2 ? *middle : 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

// Standard deviation, by medians.
double measure_deviation(std::vector<double> values) {
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    if (values.empty())
        return std::numeric_limits<double>::quiet_NaN();
    const double middle = find_median(values);
    for (double& value : values)
        value = std::abs(value - middle);
    return DEVIATION * find_median(values);
}

double square(float distance) {
    return static_cast<double>(distance) * static_cast<double>(distance);
}

// Epanechnikov's, of the k nearest.
double estimate_density(std::span<const float> distances, std::uint32_t k) {
    const double reach2 = square(distances[k]);
    double sum = 0;
    for (const float distance : distances.first(k))
        sum += 1 - square(distance) / reach2;
    return 2 / (std::numbers::pi * reach2) * sum;
}

// ψ₁ of a whole number, the sum of 1/n² from k on.
double find_trigamma(std::uint32_t k) {
    double value = std::numbers::pi * std::numbers::pi / 6;
    for (std::uint32_t n = 1; n < k; ++n)
        value -= 1.0 / (static_cast<double>(n) * n);
    return value;
}

} // namespace

Evenness measure_evenness(std::span<const float> distances) {
    const std::size_t count = distances.size() / EVENNESS_NEIGHBORS;
    if (count < FEWEST_PHOTONS)
        return {};
    std::vector<double> bends(count), ratios(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::span<const float> row = distances.subspan(i * EVENNESS_NEIGHBORS, EVENNESS_NEIGHBORS);
        bends[i] = std::log(square(row[24])) - 2 * std::log(square(row[49])) + std::log(square(row[99]));
        ratios[i] = estimate_density(row, FEW) / estimate_density(row, MANY);
    }
    const double bend = measure_deviation(std::move(bends));
    return {bend * bend / (find_trigamma(25) - find_trigamma(100)), measure_deviation(std::move(ratios))};
}

} // namespace photonloupe
