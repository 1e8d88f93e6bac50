// SPDX-License-Identifier: Apache-2.0
// Draws the points: context beneath, the selection on top; or, of very many, how densely they lie.
#include "inspect/scatter.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "image/image.h"
#include "image/png.h"

namespace photonloupe::inspect {
namespace {

constexpr glm::vec3 CONTEXT_COLOR{0.08f}; // linear: dark grey

// Linear sums of the points drawn on each pixel.
struct Canvas {
    const ScatterSettings& settings;
    std::vector<glm::vec3> color;
    std::vector<std::uint32_t> count;

    explicit Canvas(const ScatterSettings& asked)
        : settings(asked), color(std::size_t{asked.width} * asked.height), count(color.size()) {}

    // The last point drawn wins.
    void splat(const glm::dvec2& center, const glm::vec3& of);
    // All points count.
    void add(const glm::dvec2& center, const glm::vec3& of);
};

void Canvas::splat(const glm::dvec2& center, const glm::vec3& of) {
    const double radius = settings.point_radius;
    const auto last = [](double value, std::uint32_t size) { return std::min(value, static_cast<double>(size) - 1); };
    const double bottom = last(std::floor(center.y + radius), settings.height);
    const double right = last(std::floor(center.x + radius), settings.width);
    for (double row = std::max(std::floor(center.y - radius), 0.0); row <= bottom; ++row)
        for (double column = std::max(std::floor(center.x - radius), 0.0); column <= right; ++column) {
            const double dx = column + 0.5 - center.x, dy = row + 0.5 - center.y;
            const bool is_own = std::floor(center.x) == column && std::floor(center.y) == row;
            if (!is_own && dx * dx + dy * dy > radius * radius)
                continue;
            const auto at = static_cast<std::size_t>(row) * settings.width + static_cast<std::size_t>(column);
            color[at] = of;
            count[at] = 1;
        }
}

void Canvas::add(const glm::dvec2& center, const glm::vec3& of) {
    const auto at = static_cast<std::size_t>(center.y) * settings.width + static_cast<std::size_t>(center.x);
    color[at] += of;
    ++count[at];
}

// Points that have both values and lie within the image, in the order drawn.
struct Points {
    std::vector<glm::dvec2> pixels;
    std::vector<std::uint32_t> ids;
};

Points place_points(const Column& x, const Column& y, const ScatterFrame& frame, const ScatterSettings& settings) {
    Points points;
    for (std::uint32_t id = 0; id < x.values.size(); ++id) {
        if (!std::isfinite(x.values[id]) || !std::isfinite(y.values[id]))
            continue;
        const glm::dvec2 pixel = frame.to_pixel(x.values[id], y.values[id]);
        if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < settings.width && pixel.y < settings.height))
            continue;
        points.pixels.push_back(pixel);
        points.ids.push_back(id);
    }
    return points;
}

void write_pixels(ScatterPlot& plot, const Canvas& canvas) {
    const std::uint32_t most = canvas.count.empty() ? 0 : *std::max_element(canvas.count.begin(), canvas.count.end());
    plot.rgba.reserve(4 * canvas.count.size());
    for (std::size_t at = 0; at < canvas.count.size(); ++at) {
        const float count = static_cast<float>(canvas.count[at]);
        for (int channel = 0; channel < 3; ++channel)
            plot.rgba.push_back(count > 0 ? encode_srgb(canvas.color[at][channel] / count, 0.0) : 0);
        const float alpha = plot.is_dense ? std::log1p(count) / std::log1p(static_cast<float>(most)) : 1.0f;
        plot.rgba.push_back(count > 0 ? static_cast<std::uint8_t>(std::lround(255 * alpha)) : 0);
    }
}

// Counts the polygon's edges to the right of the point.
bool is_inside(const glm::dvec2& point, std::span<const glm::dvec2> polygon) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2& a = polygon[i];
        const glm::dvec2& b = polygon[(i + 1) % polygon.size()];
        // Half open, so that a corner at the point's height counts once.
        if ((a.y > point.y) != (b.y > point.y) && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x))
            inside = !inside;
    }
    return inside;
}

void require_columns(const Column& x, const Column& y, std::span<const glm::vec3> colors,
                     const ScatterSettings& settings) {
    check_image_size(settings.width, settings.height, "scatter");
    if (x.values.size() != y.values.size() || colors.size() != x.values.size())
        throw Error("scatter: " + x.name + " has " + std::to_string(x.values.size()) + " values, " + y.name + " " +
                    std::to_string(y.values.size()) + ", and there are " + std::to_string(colors.size()) +
                    " colors; all must be of the same photons");
}

} // namespace

ScatterPlot plot_scatter(const Column& x, const Column& y, std::span<const glm::vec3> colors,
                         const Selection* selection, const ScatterSettings& settings) {
    require_columns(x, y, colors, settings);
    ScatterPlot plot{settings.width, settings.height, {}, ScatterFrame(x, y, settings)};
    const Points points = place_points(x, y, plot.frame, settings);
    std::vector<bool> is_selected(x.values.size(), !selection);
    for (const std::uint32_t id : selection ? *selection : Selection{})
        if (id < is_selected.size())
            is_selected[id] = true;
    plot.drawn_count = points.ids.size();
    plot.is_dense = points.ids.size() >= settings.dense_from;
    Canvas canvas(settings);
    for (const bool draws_selected : {false, true})
        for (std::size_t i = 0; i < points.ids.size(); ++i) {
            if (is_selected[points.ids[i]] != draws_selected)
                continue;
            const glm::vec3 color = draws_selected ? colors[points.ids[i]] : CONTEXT_COLOR;
            plot.is_dense ? canvas.add(points.pixels[i], color) : canvas.splat(points.pixels[i], color);
        }
    write_pixels(plot, canvas);
    return plot;
}

Selection find_in_lasso(const Column& x, const Column& y, const ScatterFrame& frame,
                        std::span<const glm::dvec2> polygon) {
    Selection selection;
    for (std::uint32_t id = 0; id < std::min(x.values.size(), y.values.size()); ++id)
        if (std::isfinite(x.values[id]) && std::isfinite(y.values[id]) &&
            is_inside(frame.to_pixel(x.values[id], y.values[id]), polygon))
            selection.push_back(id);
    return selection;
}

} // namespace photonloupe::inspect
