// SPDX-License-Identifier: Apache-2.0
// Writes parallel coordinates as SVG.
#include "inspect/parallel_figure.h"

#include <cmath>
#include <cstdio>

#include <glm/common.hpp>

#include "core/atomic_file.h"
#include "image/png.h"
#include "inspect/photon_colors.h"

namespace photonloupe::inspect {
namespace {

constexpr FigureStyle STYLE;
// Marks along an axis, ends included, and their length in pixels.
constexpr int TICK_COUNT = 5;
constexpr float TICK_LENGTH = 4;

template <class... Values>
std::string format(const char* pattern, Values... values) {
    char text[256];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

std::string format_color(glm::vec3 color) {
    const glm::vec3 bytes = glm::clamp(color, 0.0f, 1.0f) * 255.0f + 0.5f;
    return format("#%02x%02x%02x", int(bytes.r), int(bytes.g), int(bytes.b));
}

std::string escape(const std::string& text) {
    std::string escaped;
    for (char letter : text)
        escaped += letter == '&' ? "&amp;" : letter == '<' ? "&lt;" : letter == '>' ? "&gt;" : std::string(1, letter);
    return escaped;
}

// The curve of each run of gaps without a break.
std::string format_path(const Curves& curves, std::size_t curve) {
    std::string path;
    bool is_open = false;
    for (std::size_t gap = 0; gap < curves.gap_count(); ++gap) {
        const auto [from, from_handle, to_handle, to] = find_bezier(curves, curve, gap);
        if (std::isnan(from_handle.y)) {
            is_open = false;
            continue;
        }
        if (!is_open)
            path += format("M%.2f %.2f", from.x, from.y);
        path += format("C%.2f %.2f %.2f %.2f %.2f %.2f", from_handle.x, from_handle.y, to_handle.x, to_handle.y, to.x,
                       to.y);
        is_open = true;
    }
    return path;
}

void add_curves(std::string& svg, const Curves& curves, std::span<const glm::vec3> colors, glm::vec3 otherwise,
                float opacity, const CurveStyle& style) {
    svg += format("<g fill=\"none\" stroke-width=\"%g\" stroke-opacity=\"%g\" stroke=\"", style.line_width, opacity);
    svg += format_color(otherwise) + "\">\n";
    for (std::size_t i = 0; i < curves.count(); ++i) {
        const std::string path = format_path(curves, i);
        if (path.empty())
            continue;
        svg += "<path d=\"" + path + '"';
        if (i < colors.size())
            svg += " stroke=\"" + format_color(colors[i]) + '"';
        svg += "/>\n";
    }
    svg += "</g>\n";
}

std::string encode_base64(std::span<const unsigned char> bytes) {
    constexpr char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? DIGITS[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

void add_image(std::string& svg, const CurveImage& source) {
    Image image{source.width, source.height, {}, {}};
    const std::vector<std::uint8_t> pixels = read_pixels(source);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        if (i % 4 != 3)
            image.rgb.push_back(linearize(pixels[i] / 255.0f));
    svg += format("<image width=\"%u\" height=\"%u\" href=\"data:image/png;base64,", source.width, source.height);
    svg += encode_base64(encode_png(image, 0)) + "\"/>\n";
}

void add_polygon(std::string& svg, const std::vector<glm::vec2>& outline, const char* color, float opacity) {
    if (outline.empty())
        return;
    svg += format("<polygon fill=\"%s\" fill-opacity=\"%g\" points=\"", color, opacity);
    for (glm::vec2 point : outline)
        svg += format("%.2f,%.2f ", point.x, point.y);
    svg += "\"/>\n";
}

void add_text(std::string& svg, float x, float y, const std::string& text) {
    svg += format("<text x=\"%.1f\" y=\"%.1f\">", x, y) + escape(text) + "</text>\n";
}

void add_axis_line(std::string& svg, const Axis& axis, const AxisPlace& place) {
    if (axis.is_closed)
        svg += format("<ellipse cx=\"%g\" cy=\"%g\" rx=\"%g\" ry=\"%g\"/>\n", place.center.x, place.center.y, place.rx,
                      place.ry);
    else
        svg += format("<line x1=\"%g\" y1=\"%g\" x2=\"%g\" y2=\"%g\"/>\n", place.center.x, place.center.y - place.ry,
                      place.center.x, place.center.y + place.ry);
    for (const auto& [from, to] : list_ticks(axis, place))
        svg += format("<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\"/>\n", from.x, from.y, to.x, to.y);
}

void add_labels(std::string& svg, const Axis& axis, const AxisPlace& place, const Column& column) {
    const float top = place.center.y - place.ry, bottom = place.center.y + place.ry;
    const auto [above, below] = find_limit_labels(axis);
    add_text(svg, place.center.x, top - 1.6f * STYLE.font_size, column.label.empty() ? column.name : column.label);
    add_text(svg, place.center.x, top - 0.4f * STYLE.font_size, above);
    add_text(svg, place.center.x, bottom + 1.2f * STYLE.font_size, below);
}

void add_curves_or_image(std::string& svg, const ParallelFigure& figure) {
    const CurveStyle& style = figure.style;
    if (figure.image.is_density)
        return add_image(svg, figure.image);
    add_curves(svg, figure.context, {}, style.context_color, style.context_opacity, style);
    add_curves(svg, figure.selected, figure.colors, style.selected_color, style.opacity, style);
}

void add_areas(std::string& svg, const ParallelFigure& figure) {
    for (std::size_t i = 0; i < figure.densities.size(); ++i)
        for (const auto& outline :
             outline_density(figure.axes[i], figure.layout.places[i], figure.densities[i], STYLE.density_width))
            add_polygon(svg, outline, STYLE.density_color, STYLE.density_opacity);
    for (std::size_t i = 0; i < figure.axes.size(); ++i)
        for (const Interval& brush : figure.axes[i].brushes)
            add_polygon(svg, outline_brush(figure.axes[i], figure.layout.places[i], brush, STYLE.brush_width),
                        STYLE.brush_color, STYLE.brush_opacity);
}

std::string format_parallel_svg(const ParallelFigure& figure, std::span<const Column> columns) {
    const auto [width, height] = std::pair(figure.layout.width, figure.layout.height);
    std::string svg =
        format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%u\" height=\"%u\" viewBox=\"0 0 %u %u\">\n", width,
               height, width, height);
    svg += "<rect width=\"100%\" height=\"100%\" fill=\"" + format_color(glm::vec3(figure.style.background)) +
           format("\" fill-opacity=\"%g\"/>\n", figure.style.background.a);
    add_curves_or_image(svg, figure);
    add_areas(svg, figure);
    svg += format("<g fill=\"none\" stroke=\"%s\">\n", STYLE.axis_color);
    for (std::size_t i = 0; i < figure.axes.size(); ++i)
        add_axis_line(svg, figure.axes[i], figure.layout.places[i]);
    svg += format("</g>\n<g fill=\"%s\" font-family=\"sans-serif\" font-size=\"%g\" text-anchor=\"middle\">\n",
                  STYLE.axis_color, STYLE.font_size);
    for (std::size_t i = 0; i < figure.axes.size(); ++i)
        add_labels(svg, figure.axes[i], figure.layout.places[i], columns[figure.axes[i].column]);
    return svg + "</g>\n</svg>\n";
}

} // namespace

LimitLabels find_limit_labels(const Axis& axis) {
    const std::string low = format("%.4g", axis.low), high = format("%.4g", axis.high);
    if (!axis.is_closed)
        return axis.is_flipped ? LimitLabels{low, high} : LimitLabels{high, low};
    const std::string turns = axis.periods > 1 ? format("%u turns", axis.periods) : std::string();
    return {turns, low + " = " + high};
}

std::vector<std::array<glm::vec2, 2>> list_ticks(const Axis& axis, const AxisPlace& place) {
    std::vector<std::array<glm::vec2, 2>> ticks;
    for (int i = 0; i < TICK_COUNT; ++i) {
        const glm::vec2 point = find_point(axis, place, double(i) / (TICK_COUNT - 1));
        ticks.push_back({point, point - TICK_LENGTH * find_outward(place, point)});
    }
    return ticks;
}

void write_parallel_svg(const std::filesystem::path& path, const ParallelFigure& figure,
                        std::span<const Column> columns) {
    const std::string svg = format_parallel_svg(figure, columns);
    write_file_atomically(path, {reinterpret_cast<const unsigned char*>(svg.data()), svg.size()});
}

} // namespace photonloupe::inspect
