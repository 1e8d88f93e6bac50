// SPDX-License-Identifier: Apache-2.0
// Estimates the scale from a sample of photons, evenly spaced in the tree over parameters.
#include "photons/layers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace photonloupe {
namespace {

constexpr std::size_t SAMPLE = 2048; // photons that stand for the map …
constexpr std::size_t PROBES = 64;   // … and those of them whose layers are looked at
constexpr float LARGEST_SCALE = 1e12f;

struct Sample {
    std::vector<glm::vec4> points, rows;
    std::size_t count = 0;
};

Sample draw_sample(const KdTree& tree) {
    Sample sample;
    sample.count = std::min<std::size_t>(tree.count, SAMPLE);
    const std::vector<glm::vec4> points = tree.positions.read<glm::vec4>(tree.count);
    const std::vector<glm::vec4> rows = tree.rows.read<glm::vec4>(tree.count * tree.range_rows);
    for (std::size_t i = 0; i < sample.count; ++i) {
        const std::size_t at = i * tree.count / sample.count;
        sample.points.push_back(points[at]);
        for (std::size_t row = 0; row < tree.range_rows; ++row)
            sample.rows.push_back(rows[at * tree.range_rows + row]);
    }
    return sample;
}

// The area that the photons would cover if they lay evenly in the two directions in which they spread most.
double estimate_area(const Sample& sample) {
    std::array<double, 3> variance{};
    for (int axis = 0; axis < 3; ++axis) {
        double sum = 0, squares = 0;
        for (const glm::vec4& point : sample.points) {
            const double d = static_cast<double>(point[axis]) - sample.points[0][axis];
            sum += d;
            squares += d * d;
        }
        const auto n = static_cast<double>(sample.count);
        variance[static_cast<std::size_t>(axis)] = std::max(squares / n - sum * sum / (n * n), 0.0);
    }
    std::sort(variance.begin(), variance.end());
    return 12.0 * std::sqrt(variance[2] * variance[1]);
}

double measure_rows2(const ParameterTree& tree, const glm::vec4* a, const glm::vec4* b,
                     const std::vector<glm::vec4>& periods) {
    double sum = 0;
    for (std::uint32_t axis = 1; axis < tree.parameters->rows.axis_count; ++axis) {
        const int at = static_cast<int>(axis % 4);
        double d = static_cast<double>(a[axis / 4][at]) - b[axis / 4][at];
        if (const double period = periods[axis / 4][at]; period > 0)
            d -= period * std::nearbyint(d / period);
        sum += d * d;
    }
    return sum;
}

} // namespace

float choose_parameter_scale(gpu::Device& device, const ParameterTree& by_parameters, std::uint32_t k, float beta,
                             const Progress& progress) {
    const KdTree& tree = by_parameters.tree;
    if (tree.count == 0)
        return 1.0f;
    const Sample sample = draw_sample(tree);
    const std::size_t width = tree.range_rows, probes = std::min(PROBES, sample.count);
    std::vector<glm::vec4> points, rows;
    for (std::size_t i = 0; i < probes; ++i) {
        const std::size_t at = i * sample.count / probes;
        points.push_back(sample.points[at]);
        rows.insert(rows.end(), &sample.rows[at * width], &sample.rows[at * width] + width);
    }
    const gpu::Buffer point_buffer = gpu::make_buffer(device, points, "sampled photons");
    const gpu::Buffer row_buffer = gpu::make_buffer(device, rows, "sampled photons");
    const Queries queries{probes, &point_buffer, nullptr, &row_buffer};
    const std::vector<glm::vec4> radii =
        find_parameter_radii(device, by_parameters, queries, k, progress).read<glm::vec4>(probes);
    const std::vector<glm::vec4> periods = by_parameters.parameters->periods.read<glm::vec4>(width);
    const double area = estimate_area(sample), wanted = k + 2.0;
    std::vector<float> scales;
    for (std::size_t i = 0; i < probes; ++i) {
        const double reach2 = static_cast<double>(beta) * beta * radii[i].x;
        std::size_t members = 0;
        for (std::size_t other = 0; other < sample.count; ++other)
            members += sample.rows[other * width].x == rows[i * width].x &&
                       measure_rows2(by_parameters, &rows[i * width], &sample.rows[other * width], periods) <= reach2;
        const double share = static_cast<double>(members) / static_cast<double>(sample.count);
        const double layer = std::max(share * static_cast<double>(tree.count), wanted);
        const double sought = std::sqrt(wanted * area / (std::numbers::pi * layer));
        scales.push_back(static_cast<float>(std::min<double>(sought / std::sqrt(reach2 + 1e-60), LARGEST_SCALE)));
    }
    std::nth_element(scales.begin(), scales.begin() + static_cast<std::ptrdiff_t>(probes / 2), scales.end());
    return scales[probes / 2];
}

} // namespace photonloupe
