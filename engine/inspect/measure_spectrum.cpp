// SPDX-License-Identifier: Apache-2.0
// Lists the frequencies and streams the points past them, block by block.
#include "inspect/measure_spectrum.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/vec4.hpp>

#include "gpu/commands.h"

namespace photonloupe::inspect {
namespace {

// Pairs of points that one dispatch adds up: a quarter of the loop turns an invocation has (shaders/shared/turns.glsl).
constexpr std::uint64_t PAIRS_PER_BLOCK = 16384;
// Frequencies of the smallest chunk: a few workgroups, and some milliseconds on the software device.
constexpr std::uint64_t FREQUENCY_GRANULE = 256;
// Coordinates are fractions of this many units, in the lower bits of a float between 2^-63 and 2, so that no device
// takes its bits for a NaN or flushes them to zero.
constexpr std::uint32_t UNITS_PER_PERIOD = 1u << 29;

struct SpectrumPush {
    std::uint32_t frequency_first;
    std::uint32_t frequency_count;
    std::uint32_t pair_first;
    std::uint32_t pair_end;
};

std::uint32_t quantize(double coordinate) {
    return UNITS_PER_PERIOD |
           (static_cast<std::uint32_t>(std::llround(coordinate * UNITS_PER_PERIOD)) & (UNITS_PER_PERIOD - 1));
}

// Two points a row; an odd point's partner stands at the origin, where its wave is exactly 1.
std::vector<glm::uvec4> pair_points(std::span<const glm::dvec2> points) {
    std::vector<glm::uvec4> pairs((points.size() + 1) / 2, glm::uvec4(UNITS_PER_PERIOD));
    for (std::size_t i = 0; i < points.size(); ++i) {
        glm::uvec4& pair = pairs[i / 2];
        (i % 2 == 0 ? pair.x : pair.z) = quantize(points[i].x);
        (i % 2 == 0 ? pair.y : pair.w) = quantize(points[i].y);
    }
    return pairs;
}

// The largest whole x with (x/radius)² ≤ share.
std::int32_t find_half_width(double radius, double share) {
    return share < 0.0 ? -1 : static_cast<std::int32_t>(std::floor(radius * std::sqrt(share)));
}

double compute_power(const glm::vec4& sum, std::uint64_t point_count) {
    const double partner = point_count % 2 == 0 ? 0.0 : 1.0;
    const double real = static_cast<double>(sum.x) - sum.z - partner, imaginary = static_cast<double>(sum.y) - sum.w;
    return (real * real + imaginary * imaginary) / static_cast<double>(point_count);
}

// The frequencies of the half plane within an ellipse of these half-axes, cycles over each side.
std::vector<glm::ivec2> list_half_plane(glm::dvec2 radius) {
    if (!(radius.x >= 0.0 && radius.y >= 0.0 && std::max(radius.x, radius.y) <= MAX_SPECTRUM_RADIUS))
        throw Error("the largest frequency is " + std::to_string(radius.x) + ", " + std::to_string(radius.y) +
                    " cycles over the sides; it must be from 0 to " + std::to_string(int(MAX_SPECTRUM_RADIUS)));
    std::vector<glm::ivec2> frequencies;
    for (std::int32_t x = 1; x <= find_half_width(radius.x, 1.0); ++x)
        frequencies.emplace_back(x, 0);
    for (std::int32_t y = 1; y <= radius.y; ++y) {
        const std::int32_t half_width = find_half_width(radius.x, 1.0 - (y / radius.y) * (y / radius.y));
        for (std::int32_t x = -half_width; x <= half_width; ++x)
            frequencies.emplace_back(x, y);
    }
    return frequencies;
}

} // namespace

Spectrum measure_spectrum(gpu::Device& device, std::span<const glm::dvec2> points, glm::dvec2 radius,
                          const Progress& progress) {
    Spectrum spectrum{list_half_plane(radius), {}};
    const std::uint64_t frequency_count = spectrum.frequencies.size(), point_count = points.size();
    if (frequency_count == 0 || point_count == 0) {
        spectrum.power.assign(frequency_count, 0.0);
        return spectrum;
    }
    const gpu::Buffer pairs = gpu::make_buffer(device, pair_points(points), "points");
    const std::uint64_t pair_count = (point_count + 1) / 2;
    const gpu::Buffer frequencies = gpu::make_buffer(device, spectrum.frequencies, "frequencies");
    const gpu::Buffer sums = gpu::make_buffer(device, std::vector<glm::vec4>(frequency_count), "spectrum");
    for (std::uint64_t begin = 0; begin < pair_count; begin += PAIRS_PER_BLOCK) {
        const std::uint64_t end = std::min(begin + PAIRS_PER_BLOCK, pair_count);
        const Progress within{[&](std::string_view stage, double fraction) {
            const double done = static_cast<double>(begin) + fraction * static_cast<double>(end - begin);
            return !progress.callback || progress.callback(stage, done / static_cast<double>(pair_count));
        }};
        gpu::run_in_chunks(
            device, "measure spectrum", frequency_count, FREQUENCY_GRANULE, within,
            [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
                const SpectrumPush push{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count),
                                        static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
                commands.dispatch({"relax/measure_spectrum.comp", 64, {}, {}},
                                  {{"points", pairs}, {"frequencies", frequencies}, {"sums", sums}}, push, count);
            });
    }
    spectrum.power.reserve(frequency_count);
    for (const glm::vec4& sum : sums.read<glm::vec4>(frequency_count))
        spectrum.power.push_back(compute_power(sum, point_count));
    return spectrum;
}

} // namespace photonloupe::inspect
