// SPDX-License-Identifier: Apache-2.0
// Kernel density by binning: values go to the two nearest of some thousand bins, and the kernel runs over bins.
#include "inspect/parallel_density.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "inspect/histogram.h"

namespace photonloupe::inspect {
namespace {

constexpr double BINS_PER_BANDWIDTH = 6;
// Standard deviations beyond which a kernel counts for nothing (e^-12.5).
constexpr double REACH = 5;
// A value put on two bins is spread by a triangle of this variance, in bins²; the kernel is narrower by as much.
constexpr double BIN_VARIANCE = 1.0 / 6.0;
// Half of a bar, pixels along the axis.
constexpr float HALF_BAR = 2;

std::vector<double> list_finite(const Column& column, const Selection& photons) {
    std::vector<double> values;
    values.reserve(photons.size());
    for (std::uint32_t photon : photons)
        if (std::isfinite(column.values[photon]))
            values.push_back(column.values[photon]);
    return values;
}

double find_bandwidth(std::vector<double>& values) {
    const double count = static_cast<double>(values.size());
    if (count < 2)
        return 0;
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
    double squares = 0;
    for (double value : values)
        squares += (value - mean) * (value - mean);
    const double deviation = std::sqrt(squares / (count - 1));
    const double range = (find_quantile(values, 0.75) - find_quantile(values, 0.25)) / 1.34;
    return 0.9 * (range > 0 ? std::min(deviation, range) : deviation) * std::pow(count, -0.2);
}

// Values that go round, each by the turn that brings it nearest to their circular mean: two sides of one cluster that
// the axis' ends part are then neighbors again.
void unwind(std::vector<double>& values, double turn) {
    const double scale = 2 * std::numbers::pi / turn;
    double across = 0, along = 0;
    for (double value : values) {
        across += std::sin(scale * value);
        along += std::cos(scale * value);
    }
    const double mean = std::atan2(across, along) / scale;
    for (double& value : values)
        value = std::remainder(value - mean, turn);
}

// Weights of values on evenly spaced bins, in shares of the axis, that reach as far beyond its ends as kernels do, or
// go round it.
class Bins {
public:
    Bins(double bandwidth, bool wraps) : m_wraps(wraps), m_step(bandwidth / BINS_PER_BANDWIDTH) {
        if (wraps)
            m_step = 1 / std::ceil(1 / m_step);
        else
            m_first = -REACH * bandwidth;
        m_weights.resize(static_cast<std::size_t>(std::ceil((1 - 2 * m_first) / m_step)) + (wraps ? 0 : 1));
    }

    void add(double share) {
        const double place = (share - m_first) / m_step, below = std::floor(place);
        if (!m_wraps && !(below >= 0 && below + 1 < static_cast<double>(m_weights.size())))
            return;
        const auto bin = static_cast<std::size_t>(below) % m_weights.size();
        m_weights[bin] += 1 - (place - below);
        m_weights[(bin + 1) % m_weights.size()] += place - below;
    }

    // The sum of kernels at a share.
    double sum_kernels(double share, double bandwidth) const {
        const double deviation = std::sqrt(bandwidth * bandwidth - BIN_VARIANCE * m_step * m_step);
        const auto size = static_cast<std::ptrdiff_t>(m_weights.size());
        const double center = (share - m_first) / m_step, reach = REACH * deviation / m_step;
        auto bin = static_cast<std::ptrdiff_t>(std::ceil(center - reach));
        auto last = static_cast<std::ptrdiff_t>(std::floor(center + reach));
        if (!m_wraps) {
            bin = std::max<std::ptrdiff_t>(bin, 0);
            last = std::min(last, size - 1);
        }
        double sum = 0;
        for (; bin <= last; ++bin) {
            const double offset = (static_cast<double>(bin) - center) * m_step / deviation;
            sum += m_weights[static_cast<std::size_t>((bin % size + size) % size)] * std::exp(-0.5 * offset * offset);
        }
        return sum / (deviation * std::sqrt(2 * std::numbers::pi));
    }

private:
    bool m_wraps;
    double m_step = 0, m_first = 0;
    std::vector<double> m_weights;
};

void scale_to_peak(AxisDensity& density, std::span<const double> sums, double unit) {
    const double peak = sums.empty() ? 0 : *std::max_element(sums.begin(), sums.end());
    density.peak = static_cast<float>(peak * unit);
    for (double sum : sums)
        density.heights.push_back(peak > 0 ? static_cast<float>(sum / peak) : 0.0f);
}

AxisDensity count_values(const Column& column, const Axis& axis, const Selection& photons) {
    std::map<double, double> counts;
    for (double value : list_finite(column, photons)) {
        const double share = find_share(axis, static_cast<float>(value));
        if (share >= 0 && share <= 1)
            ++counts[share];
    }
    AxisDensity density{.has_bars = true};
    std::vector<double> sums;
    for (const auto& [share, count] : counts) {
        density.shares.push_back(static_cast<float>(share));
        sums.push_back(count);
    }
    scale_to_peak(density, sums, 1);
    return density;
}

} // namespace

AxisDensity estimate_density(const Column& column, const Axis& axis, const Selection& photons) {
    if (column.is_discrete)
        return count_values(column, axis, photons);
    std::vector<double> values = list_finite(column, photons);
    AxisDensity density;
    for (std::size_t i = 0; i < DENSITY_SAMPLES; ++i)
        density.shares.push_back(static_cast<float>(i) / (DENSITY_SAMPLES - 1));
    const double extent = (double(axis.high) - axis.low) / (axis.is_closed ? axis.periods : 1);
    const double finest = 1.0 / (DENSITY_SAMPLES - 1);
    std::vector<double> spread = values;
    if (axis.is_closed && extent > 0)
        unwind(spread, extent);
    const double bandwidth = extent > 0 ? std::max(find_bandwidth(spread) / extent, finest) : finest;
    density.bandwidth = static_cast<float>(bandwidth * extent);
    Bins bins(bandwidth, axis.is_closed);
    for (double value : values)
        bins.add(find_share(axis, static_cast<float>(value)));
    std::vector<double> sums;
    for (float share : density.shares)
        sums.push_back(values.empty() ? 0 : bins.sum_kernels(share, bandwidth) / static_cast<double>(values.size()));
    scale_to_peak(density, sums, extent > 0 ? 1 / extent : 1);
    return density;
}

std::vector<std::vector<glm::vec2>> outline_density(const Axis& axis, const AxisPlace& place,
                                                    const AxisDensity& density, float width) {
    const auto step_out = [&](double share, float height) {
        const glm::vec2 point = find_point(axis, place, share);
        return point + height * width * find_outward(place, point);
    };
    std::vector<std::vector<glm::vec2>> outlines;
    if (density.has_bars) {
        const double half = HALF_BAR / (2 * place.ry);
        for (std::size_t i = 0; i < density.shares.size(); ++i) {
            const double share = density.shares[i], height = density.heights[i];
            outlines.push_back({step_out(share - half, 0), step_out(share - half, static_cast<float>(height)),
                                step_out(share + half, static_cast<float>(height)), step_out(share + half, 0)});
        }
        return outlines;
    }
    std::vector<glm::vec2> outline;
    for (std::size_t i = 0; i < density.shares.size(); ++i)
        outline.push_back(step_out(density.shares[i], density.heights[i]));
    const std::size_t step = axis.is_closed ? 1 : density.shares.size() - 1; // the line needs its ends only
    for (std::size_t i = density.shares.size(); i > 0; i -= std::min(i, step))
        outline.push_back(step_out(density.shares[i - 1], 0));
    outlines.push_back(std::move(outline));
    return outlines;
}

} // namespace photonloupe::inspect
