// SPDX-License-Identifier: Apache-2.0
// Binds the parallel coordinates of engine/inspect: a figure, with what was computed for it as arrays.
#include "binding.h"

#include "inspect/parallel_figure.h"

namespace photonloupe::bindings {
namespace {

using namespace photonloupe::inspect;

// A figure with the columns it shows.
struct OpenFigure {
    std::vector<Column> columns;
    ParallelFigure figure;
};

using Values = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Ids = nb::ndarray<const std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

Column read_column(const nb::dict& given) {
    const auto values = nb::cast<Values>(given["values"]);
    return {.name = nb::cast<std::string>(given["name"]),
            .label = nb::cast<std::string>(given["label"]),
            .values = {values.data(), values.data() + values.size()},
            .low = nb::cast<float>(given["low"]),
            .high = nb::cast<float>(given["high"]),
            .period = nb::cast<float>(given["period"]),
            .is_discrete = nb::cast<bool>(given["discrete"])};
}

Axis read_axis(const nb::dict& given, std::size_t column) {
    Axis axis{.column = column,
              .low = nb::cast<float>(given["low"]),
              .high = nb::cast<float>(given["high"]),
              .is_flipped = nb::cast<bool>(given["flipped"]),
              .is_closed = nb::cast<bool>(given["closed"]),
              .periods = nb::cast<std::uint32_t>(given["periods"]),
              .brushes = {}};
    for (const auto& [low, high] : nb::cast<std::vector<std::pair<float, float>>>(given["brush"]))
        axis.brushes.push_back({low, high});
    return axis;
}

FigureSettings read_settings(const nb::dict& given) {
    FigureSettings settings;
    const auto size = nb::cast<std::array<std::uint32_t, 2>>(given["size"]);
    settings.width = size[0];
    settings.height = size[1];
    settings.tension = nb::cast<float>(given["tension"]);
    settings.has_density = nb::cast<bool>(given["density"]);
    settings.style.most_curves = nb::cast<std::uint32_t>(given["most_curves"]);
    return settings;
}

std::unique_ptr<OpenFigure> make(OpenDevice& open, const nb::list& axes, const Ids& focus, nb::object color,
                                 Matrix<const float, 3> colors, const nb::dict& settings) {
    auto made = std::make_unique<OpenFigure>();
    std::vector<Axis> read;
    for (nb::handle axis : axes) {
        made->columns.push_back(read_column(nb::cast<nb::dict>(axis)));
        read.push_back(read_axis(nb::cast<nb::dict>(axis), read.size()));
    }
    const auto* first = reinterpret_cast<const glm::vec3*>(colors.data());
    const Column colored = color.is_none() ? Column{} : read_column(nb::cast<nb::dict>(color));
    const CurveColors chosen{color.is_none() ? nullptr : &colored, {first, colors.shape(0)}};
    const FigureSettings asked = read_settings(settings);
    const Selection focused{focus.data(), focus.data() + focus.size()};
    nb::gil_scoped_release release;
    made->figure = make_parallel_figure(open.device, made->columns, std::move(read), focused, chosen, asked);
    return made;
}

nb::ndarray<nb::numpy, float> copy_vectors(const std::vector<glm::vec2>& vectors) {
    const auto* first = reinterpret_cast<const float*>(vectors.data());
    return own_array(std::vector<float>(first, first + 2 * vectors.size()), 2);
}

nb::tuple read_curves(const Curves& curves) {
    return nb::make_tuple(own_array(std::vector<std::uint32_t>(curves.photons)), copy_vectors(curves.points),
                          copy_vectors(curves.tangents), curves.broken_count);
}

nb::list read_densities(const OpenFigure& open) {
    nb::list rows;
    for (const AxisDensity& density : open.figure.densities)
        rows.append(nb::make_tuple(own_array(std::vector<float>(density.shares)),
                                   own_array(std::vector<float>(density.heights)), density.has_bars, density.bandwidth,
                                   density.peak));
    return rows;
}

// Per axis: (center x, center y, rx, ry), what stands above and below, outlines of density and of brushes, ticks.
nb::list read_marks(const OpenFigure& open) {
    constexpr FigureStyle style;
    nb::list rows;
    for (std::size_t i = 0; i < open.figure.axes.size(); ++i) {
        const Axis& axis = open.figure.axes[i];
        const AxisPlace& place = open.figure.layout.places[i];
        nb::list areas, brushes, ticks;
        if (!open.figure.densities.empty())
            for (const auto& outline : outline_density(axis, place, open.figure.densities[i], style.density_width))
                areas.append(copy_vectors(outline));
        for (const Interval& brush : axis.brushes)
            brushes.append(copy_vectors(outline_brush(axis, place, brush, style.brush_width)));
        for (const auto& [from, to] : list_ticks(axis, place))
            ticks.append(nb::make_tuple(from.x, from.y, to.x, to.y));
        const LimitLabels labels = find_limit_labels(axis);
        rows.append(nb::make_tuple(nb::make_tuple(place.center.x, place.center.y, place.rx, place.ry), labels.above,
                                   labels.below, areas, brushes, ticks));
    }
    return rows;
}

} // namespace

void bind_parallel_coordinates(nb::module_& module) {
    nb::class_<OpenFigure>(module, "ParallelFigure")
        .def(
            "read_pixels", [](const OpenFigure& open) { return own_array(read_pixels(open.figure.image), 4); },
            "RGBA (height · width, 4), sRGB.")
        .def_prop_ro("is_density", [](const OpenFigure& open) { return open.figure.image.is_density; })
        .def(
            "read_selected", [](const OpenFigure& open) { return read_curves(open.figure.selected); },
            "Of the photons in focus: ids (s,), points (s · axes, 2), tangents (s · gaps, 2), photons with a break.")
        .def(
            "read_context", [](const OpenFigure& open) { return read_curves(open.figure.context); },
            "The same of the others.")
        .def("read_densities", &read_densities,
             "Per axis: shares, heights, whether bars, bandwidth, what height 1 stands for.")
        .def("read_marks", &read_marks,
             "Per axis: (center x, center y, rx, ry), text above and below, outlines of density and brushes, ticks.")
        .def(
            "write_svg",
            [](const OpenFigure& open, const std::string& path) {
                write_parallel_svg(path, open.figure, open.columns);
            },
            "path"_a);
    module.def("make_parallel_figure", &make, "device"_a, "axes"_a, "focus"_a, "color"_a.none(), "colors"_a,
               "settings"_a,
               "Axes: name, label, values, low, high, period, discrete, flipped, closed, periods, brush each. "
               "Settings: size, tension, density, most_curves.");
}

} // namespace photonloupe::bindings
