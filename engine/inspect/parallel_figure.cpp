// SPDX-License-Identifier: Apache-2.0
// Puts parallel coordinates together.
#include "inspect/parallel_figure.h"

#include <algorithm>

#include "core/split_work.h"
#include "inspect/colormap.h"

namespace photonloupe::inspect {
namespace {

// Photons whose density another thread would not get sooner.
constexpr std::size_t SMALL_SELECTION = 4096;

Selection subtract(const Selection& first, const Selection& second) {
    Selection rest;
    std::set_difference(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(rest));
    return rest;
}

std::vector<AxisDensity> estimate_densities(std::span<const Column> columns, std::span<const Axis> axes,
                                            const Selection& photons) {
    std::vector<AxisDensity> densities(axes.size());
    split_work(axes.size(), std::max<std::size_t>(SMALL_SELECTION / (photons.size() + 1), 1),
               [&](std::size_t first, std::size_t end) {
                   for (std::size_t i = first; i < end; ++i)
                       densities[i] = estimate_density(columns[axes[i].column], axes[i], photons);
               });
    return densities;
}

// A column from its low to its high through Viridis, through Twilight where it repeats.
std::vector<glm::vec3> color_by_column(const Column& column, const Selection& photons) {
    const Colormap map = column.period > 0 ? Colormap::twilight : Colormap::viridis;
    const double extent = column.period > 0 ? column.period : double(column.high) - column.low;
    std::vector<glm::vec3> colors;
    colors.reserve(photons.size());
    for (std::uint32_t photon : photons) {
        const double share = (double(column.values[photon]) - column.low) / extent;
        colors.push_back(map_color(map, extent > 0 ? static_cast<float>(share) : 0.5f));
    }
    return colors;
}

// The colors that the figure's curves have: given by photon, or those of a column.
std::vector<glm::vec3> choose_colors(const CurveColors& colors, const Selection& photons) {
    if (colors.column)
        return color_by_column(*colors.column, photons);
    std::vector<glm::vec3> chosen;
    if (!colors.by_photon.empty())
        for (std::uint32_t photon : photons)
            chosen.push_back(colors.by_photon[photon]);
    return chosen;
}

} // namespace

ParallelFigure make_parallel_figure(gpu::Device& device, std::span<const Column> columns, std::vector<Axis> axes,
                                    const Selection& focus, const CurveColors& colors, const FigureSettings& settings) {
    check_axes(columns, axes);
    ParallelFigure figure;
    figure.axes = std::move(axes);
    figure.style = settings.style;
    figure.layout = place_axes(figure.axes, settings.width, settings.height, settings.margins);
    const Selection all = select_all(columns.empty() ? 0 : columns[0].values.size());
    Selection selected = select_brushed(figure.axes, columns, focus);
    figure.context = build_curves(columns, figure.axes, figure.layout, subtract(all, selected), settings.tension);
    figure.selected = build_curves(columns, figure.axes, figure.layout, std::move(selected), settings.tension);
    if (figure.context.count() + figure.selected.count() <= settings.style.most_curves)
        figure.colors = choose_colors(colors, figure.selected.photons);
    if (settings.has_density)
        figure.densities = estimate_densities(columns, figure.axes, figure.selected.photons);
    figure.image = draw_curves(device, figure.layout, figure.context, figure.selected, figure.colors, settings.style);
    return figure;
}

} // namespace photonloupe::inspect
