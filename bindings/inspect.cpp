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
    nb::list rows;
    for (const ColumnInfo& info : list_columns(photons)) {
        nb::dict row;
        row["name"] = info.name;
        row["label"] = info.label;
        row["period"] = info.period;
        row["discrete"] = info.is_discrete;
        row["needs_paths"] = info.needs_paths;
        row["missing"] = info.missing;
        rows.append(row);
    }
    return rows;
}

nb::dict describe_column(Column column) {
    nb::dict row;
    row["name"] = column.name;
    row["label"] = column.label;
    row["low"] = column.low;
    row["high"] = column.high;
    row["period"] = column.period;
    row["discrete"] = column.is_discrete;
    row["values"] = own_array(std::move(column.values));
    return row;
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
    nb::dict row;
    row["position"] = numbers.position;
    row["power"] = take_vector(numbers.power);
    row["parameters"] = parameters;
    row["interactions"] = numbers.interactions;
    row["signature"] = numbers.signature;
    row["tortuosity"] = numbers.tortuosity;
    row["path_length"] = numbers.path_length;
    row["one_sidedness"] = numbers.one_sidedness;
    row["drift"] = numbers.drift;
    row["pressure"] = numbers.pressure;
    return row;
}

// Rows u_b, v_b of the ellipses' directions, and their half-axes.
void describe_ellipses(nb::dict& row, const std::vector<DriftEllipse>& ellipses) {
    std::vector<float> bases, half_axes;
    for (const DriftEllipse& ellipse : ellipses) {
        for (const glm::vec3& axis : {ellipse.along, ellipse.across})
            bases.insert(bases.end(), {axis.x, axis.y, axis.z});
        half_axes.insert(half_axes.end(), {ellipse.half_along, ellipse.half_across});
    }
    row["ellipse_axes"] = own_pixels(std::move(bases), ellipses.size(), 2);
    row["ellipse_half_axes"] = own_array(std::move(half_axes), 2);
}

nb::dict describe_view(const LoupeView& view) {
    nb::dict row;
    row["center"] = view.center;
    row["ids"] = own_array(std::vector<std::uint32_t>(view.ids));
    row["distances"] = own_array(std::vector<float>(view.distances));
    row["radius"] = view.radius;
    row["positions"] = take_vectors(view.positions, view.origin);
    row["colors"] = view.colors.empty() ? nb::none() : take_vectors(view.colors);
    row["has_constraint"] = view.has_constraint;
    row["basis"] = take_vectors({view.along, view.across});
    row["freedom"] = nb::make_tuple(view.freedom_along, view.freedom_across);
    row["eigenvalues"] = nb::make_tuple(view.spread.along_variance, view.spread.across_variance);
    row["eigenvectors"] = take_vectors({view.spread.along, view.spread.across});
    row["isotropy"] = view.spread.isotropy;
    row["numbers"] = describe_numbers(view.numbers);
    describe_ellipses(row, view.ellipses);
    return row;
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
    nb::dict row;
    row["counts"] = own_array(std::vector<std::int64_t>(histogram.counts.begin(), histogram.counts.end()));
    row["edges"] = own_array(std::move(histogram.edges));
    row["cdf"] = own_array(std::move(histogram.cdf));
    row["below"] = histogram.below;
    row["above"] = histogram.above;
    row["non_finite"] = histogram.non_finite;
    return row;
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
    module.def("list_columns", &describe_columns, nb::arg("photons"),
               "Every column a view can plot: name, label, period, discrete, needs_paths, missing.");
    module.def(
        "find_column",
        [](OpenDevice& open, Photons& photons, const std::string& name, nb::object progress) {
            return describe_column(PythonProgress(std::move(progress)).run([&](const Progress& asked) {
                return find_column(open.device, photons, name, asked);
            }));
        },
        nb::arg("device"), nb::arg("photons"), nb::arg("name"), nb::arg("progress").none() = nb::none(),
        "One column: name, label, values (n,), low, high, period, discrete.");
    module.def("count_column", &count, nb::arg("values"), nb::arg("bins"), nb::arg("range").none(), nb::arg("bounds"),
               "Histogram of values (n,): counts, edges, cdf, below, above, non_finite; bounds stand in for no range.");
    module.def(
        "find_quantile",
        [](const Matrix1& values, double share) { return find_quantile({values.data(), values.size()}, share); },
        nb::arg("values"), nb::arg("share"), "The value that a share of the finite ones lie below.");
    module.def(
        "find_share_above",
        [](const Matrix1& values, double threshold) {
            return find_share_above({values.data(), values.size()}, threshold);
        },
        nb::arg("values"), nb::arg("threshold"), "Share of the finite values above a threshold.");
    module.def("look_through_loupe", &look, nb::arg("device"), nb::arg("photons"), nb::arg("query"),
               nb::arg("progress").none() = nb::none(),
               "What a loupe shows; query: point, normal, photon, k, space, beta, center, low, high.");
    module.def("read_path_lines", &list_lines, nb::arg("photons"), nb::arg("ids"),
               "(vertices (m, 3), interactions (m,)) of each photon's path.");
    module.def("measure_spectrum", &measure, nb::arg("device"), nb::arg("points"), nb::arg("radius"),
               nb::arg("progress").none() = nb::none(),
               "Frequencies (m, 2) of a half plane up to `radius` cycles over the sides, and the power (m,) of points "
               "(n, 2) in sides.");
}

} // namespace photonloupe::bindings
