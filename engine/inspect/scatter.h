// SPDX-License-Identifier: Apache-2.0
// Photons as points of a plane of two columns ([SJL15] figures 9 f, 10): Cartesian, or polar by angle and radius.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "inspect/column.h"

namespace photonloupe::inspect {

using Range = std::pair<double, double>;

struct ScatterSettings {
    std::uint32_t width = 512, height = 512;
    bool is_polar = false;                 // x is the angle, y the radius
    float point_radius = 1.5f;             // pixels
    std::uint32_t dense_from = 100'000;    // from so many points on their density is drawn, on a logarithmic scale
    std::optional<Range> x_range, y_range; // by default the columns' own
};

// Between data and pixels; pixel (0, 0) is the upper corner on the left, y points down.
class ScatterFrame {
public:
    ScatterFrame(const Column& x, const Column& y, const ScatterSettings& settings);

    // Polar: angle 0 points up, a quarter of a turn to the right, so that (θ, φ) lie as (θ sin φ, θ cos φ).
    glm::dvec2 to_pixel(double x, double y) const;
    // Of polar frames the angle within x_range.
    glm::dvec2 to_data(const glm::dvec2& pixel) const;
    Range x_range() const { return m_x; }
    Range y_range() const { return m_y; }

private:
    Range m_x, m_y;
    bool m_is_polar = false;
    double m_turn = 0;                 // of the angle
    double m_angle_origin = 0;         // the angle that points up
    glm::dvec2 m_corner{}, m_extent{}; // of the area that the ranges fill
};

struct ScatterPlot {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba; // sRGB, straight alpha; row 0 at the top; alpha 0 where no point lies
    ScatterFrame frame;
    std::uint64_t drawn_count = 0; // points with both values, within the image
    bool is_dense = false;
};

// `colors` are linear, one a photon. With a selection the others stay as context, in grey beneath it.
// Throws Error for columns of different lengths or a size out of range.
ScatterPlot plot_scatter(const Column& x, const Column& y, std::span<const glm::vec3> colors,
                         const Selection* selection, const ScatterSettings& settings);

// Ids whose place in the plot lies inside, by the even-odd rule; `polygon` is in pixels and closes itself.
Selection find_in_lasso(const Column& x, const Column& y, const ScatterFrame& frame,
                        std::span<const glm::dvec2> polygon);

} // namespace photonloupe::inspect
