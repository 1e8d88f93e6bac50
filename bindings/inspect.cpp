// SPDX-License-Identifier: Apache-2.0
// Binds engine/inspect: columns, histograms, the loupe, spectra.
#include "binding.h"

#include "inspect/columns/columns.h"
#include "inspect/histogram.h"
#include "inspect/loupe.h"
#include "inspect/measure_spectrum.h"
#include "settings.h"

namespace photonloupe::bindings {
namespace {

using namespace inspect;

using Matrix1 = nb::ndarray<nb::numpy, const float, nb::ndim<1>, nb::c_contig>;

nb::list describe_columns(const Photons& photons) {
    return list_rows(list_columns(photons), [](const ColumnInfo& info) {
        return make_row("name"_a = info.name, "label"_a = info.label, "period"_a = info.period,
                        "discrete"_a = info.is_discrete, "needs_paths"_a = info.needs_paths,
                        "missing"_a = info.missing);
    });
}

nb::dict describe_column(Column column) {
    return make_row("name"_a = column.name, "label"_a = column.label, "low"_a = column.low, "high"_a = column.high,
                    "period"_a = column.period, "discrete"_a = column.is_discrete,
                    "values"_a = own_array(std::move(column.values)));
}

nb::tuple take_vector(const glm::vec3& v) {
    return nb::make_tuple(v.x, v.y, v.z);
}

nb::object take_vectors(const std::vector<glm::vec3>& vectors, const std::array<double, 3>& origin = {}) {
    std::vector<float> values;
    for (const glm::vec3& v : vectors)
        for (int axis = 0; axis < 3; ++axis)
            values.push_back(static_cast<float>(v[axis] + origin[axis]));
    return nb::cast(own_array(std::move(values), 3));
}

LoupeQuery read_query(const nb::dict& given) {
    LoupeQuery query{read_settings<LoupeSettings>(given)};
    query.photon = nb::cast<std::optional<std::uint32_t>>(given["photon"]);
    query.pinned = nb::cast<std::optional<std::uint32_t>>(given["center"]);
    if (!given["point"].is_none())
        query.point = nb::cast<std::array<double, 3>>(given["point"]);
    if (!given["normal"].is_none()) {
        const auto normal = nb::cast<std::array<float, 3>>(given["normal"]);
        query.normal = glm::vec3(normal[0], normal[1], normal[2]);
    }
    if (!given["low"].is_none()) {
        query.low = nb::cast<std::vector<float>>(given["low"]);
        query.high = nb::cast<std::vector<float>>(given["high"]);
    }
    return query;
}

nb::dict describe_numbers(const LoupeNumbers& numbers) {
    nb::dict parameters;
    for (const auto& [name, value] : numbers.parameters)
        parameters[nb::str(name.c_str())] = value;
    return make_row("position"_a = numbers.position, "power"_a = take_vector(numbers.power),
                    "parameters"_a = parameters, "interactions"_a = numbers.interactions,
                    "signature"_a = numbers.signature, "tortuosity"_a = numbers.tortuosity,
                    "path_length"_a = numbers.path_length, "one_sidedness"_a = numbers.one_sidedness,
                    "drift"_a = numbers.drift, "pressure"_a = numbers.pressure);
}

nb::dict describe_view(const LoupeView& view) {
    std::vector<float> bases, half_axes; // rows u_b, v_b of the ellipses' directions, and their half-axes
    for (const DriftEllipse& ellipse : view.ellipses) {
        for (const glm::vec3& axis : {ellipse.along, ellipse.across})
            bases.insert(bases.end(), {axis.x, axis.y, axis.z});
        half_axes.insert(half_axes.end(), {ellipse.half_along, ellipse.half_across});
    }
    return make_row("center"_a = view.center, "ids"_a = own_array(std::vector<std::uint32_t>(view.ids)),
                    "distances"_a = own_array(std::vector<float>(view.distances)), "radius"_a = view.radius,
                    "positions"_a = take_vectors(view.positions, view.origin),
                    "colors"_a = view.colors.empty() ? nb::none() : take_vectors(view.colors),
                    "has_constraint"_a = view.has_constraint, "basis"_a = take_vectors({view.along, view.across}),
                    "freedom"_a = nb::make_tuple(view.freedom_along, view.freedom_across),
                    "eigenvalues"_a = nb::make_tuple(view.spread.along_variance, view.spread.across_variance),
                    "eigenvectors"_a = take_vectors({view.spread.along, view.spread.across}),
                    "isotropy"_a = view.spread.isotropy, "numbers"_a = describe_numbers(view.numbers),
                    "ellipse_axes"_a = own_pixels(std::move(bases), view.ellipses.size(), 2),
                    "ellipse_half_axes"_a = own_array(std::move(half_axes), 2));
}

nb::dict look(OpenDevice& open, Photons& photons, const nb::dict& given, nb::object progress) {
    const LoupeQuery query = read_query(given);
    return describe_view(PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return look_through_loupe(open.device, photons, query, asked);
    }));
}

nb::list list_lines(const Photons& photons, const std::vector<std::uint32_t>& ids) {
    nb::list lines;
    for (PathLine& line : read_path_lines(photons, ids))
        lines.append(
            nb::make_tuple(take_vectors(line.points, photons.map.origin), own_array(std::move(line.interactions))));
    return lines;
}

nb::dict count(const Matrix1& values, std::uint32_t bins, std::optional<std::pair<double, double>> range,
               std::pair<float, float> bounds) {
    Column column;
    column.values.assign(values.data(), values.data() + values.size());
    column.low = bounds.first;
    column.high = bounds.second;
    ColumnHistogram histogram = count_column(column, bins, range);
    return make_row("counts"_a = own_array(std::vector<std::int64_t>(histogram.counts.begin(), histogram.counts.end())),
                    "edges"_a = own_array(std::move(histogram.edges)), "cdf"_a = own_array(std::move(histogram.cdf)),
                    "below"_a = histogram.below, "above"_a = histogram.above, "non_finite"_a = histogram.non_finite);
}

nb::tuple measure(OpenDevice& open, Matrix<const double, 2> points, std::array<double, 2> radius, nb::object progress) {
    const auto* first = reinterpret_cast<const glm::dvec2*>(points.data());
    Spectrum spectrum = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return measure_spectrum(open.device, {first, points.shape(0)}, {radius[0], radius[1]}, asked);
    });
    std::vector<std::int32_t> frequencies;
    frequencies.reserve(2 * spectrum.frequencies.size());
    for (const glm::ivec2& frequency : spectrum.frequencies)
        frequencies.insert(frequencies.end(), {frequency.x, frequency.y});
    return nb::make_tuple(own_array(std::move(frequencies), 2), own_array(std::move(spectrum.power)));
}

} // namespace

void bind_inspect(nb::module_& module) {
    module.def("list_columns", &describe_columns, "photons"_a,
               "Every column a view can plot: name, label, period, discrete, needs_paths, missing.");
    module.def(
        "find_column",
        [](OpenDevice& open, Photons& photons, const std::string& name, nb::object progress) {
            return describe_column(PythonProgress(std::move(progress)).run([&](const Progress& asked) {
                return find_column(open.device, photons, name, asked);
            }));
        },
        "device"_a, "photons"_a, "name"_a, "progress"_a = nb::none(),
        "One column: name, label, values (n,), low, high, period, discrete.");
    module.def("count_column", &count, "values"_a, "bins"_a, "range"_a.none(), "bounds"_a,
               "Histogram of values (n,): counts, edges, cdf, below, above, non_finite; bounds stand in for no range.");
    module.def(
        "find_quantile",
        [](const Matrix1& values, double share) { return find_quantile({values.data(), values.size()}, share); },
        "values"_a, "share"_a, "The value that a share of the finite ones lie below.");
    module.def("look_through_loupe", &look, "device"_a, "photons"_a, "query"_a, "progress"_a = nb::none(),
               "What a loupe shows; query: point, normal, photon, k, space, beta, center, low, high.");
    module.def("read_path_lines", &list_lines, "photons"_a, "ids"_a,
               "(vertices (m, 3), interactions (m,)) of each photon's path.");
    module.def("measure_spectrum", &measure, "device"_a, "points"_a, "radius"_a, "progress"_a = nb::none(),
               "Frequencies (m, 2) of a half plane up to `radius` cycles over the sides, and the power (m,) of points "
               "(n, 2) in sides.");
}

} // namespace photonloupe::bindings
