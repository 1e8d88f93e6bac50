// SPDX-License-Identifier: Apache-2.0
// Puts parallel coordinates together.
#include "inspect/parallel_figure.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "inspect/colormap.h"

namespace photonloupe::inspect {
namespace {

Selection list_all(std::span<const Column> columns) {
    Selection all(columns.empty() ? 0 : columns[0].values.size());
    std::iota(all.begin(), all.end(), 0u);
    return all;
}

Selection intersect(const Selection& first, const Selection& second) {
    Selection both;
    std::set_intersection(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(both));
    return both;
}

Selection subtract(const Selection& first, const Selection& second) {
    Selection rest;
    std::set_difference(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(rest));
    return rest;
}

// An empty selection would mean all photons to `select_brushed`.
Selection find_focus(std::span<const Axis> axes, std::span<const Column> columns, const Selection& shown,
                     const Selection& focus) {
    const Selection within = focus.empty() ? shown : intersect(shown, focus);
    return within.empty() ? within : select_brushed(axes, columns, within);
}

} // namespace

ParallelFigure make_parallel_figure(gpu::Device& device, std::span<const Column> columns, std::vector<Axis> axes,
                                    const Selection& shown, const Selection& focus, std::span<const glm::vec3> colors,
                                    const FigureSettings& settings) {
    check_axes(columns, axes);
    ParallelFigure figure;
    figure.axes = std::move(axes);
    figure.style = settings.style;
    figure.layout = place_axes(figure.axes, settings.width, settings.height, settings.margins);
    const Selection all = shown.empty() ? list_all(columns) : shown;
    Selection selected = find_focus(figure.axes, columns, all, focus);
    figure.context = build_curves(columns, figure.axes, figure.layout, subtract(all, selected), settings.tension);
    figure.selected = build_curves(columns, figure.axes, figure.layout, std::move(selected), settings.tension);
    if (!colors.empty())
        for (std::uint32_t photon : figure.selected.photons)
            figure.colors.push_back(colors[photon]);
    if (settings.has_density)
        for (const Axis& axis : figure.axes)
            figure.densities.push_back(estimate_density(columns[axis.column], axis, figure.selected.photons));
    figure.image = draw_curves(device, figure.layout, figure.context, figure.selected, figure.colors, settings.style);
    return figure;
}

std::vector<glm::vec3> color_by_column(const Column& column) {
    const Colormap map = column.period > 0 ? Colormap::twilight : Colormap::viridis;
    const double extent = column.period > 0 ? column.period : double(column.high) - column.low;
    std::vector<glm::vec3> colors;
    colors.reserve(column.values.size());
    for (float value : column.values)
        colors.push_back(map_color(map, extent > 0 ? static_cast<float>((double(value) - column.low) / extent) : 0.5f));
    return colors;
}

} // namespace photonloupe::inspect
