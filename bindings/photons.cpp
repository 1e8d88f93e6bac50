// SPDX-License-Identifier: Apache-2.0
// Binds engine/photons: maps made, shared and parted, their parameters, the tree, neighbours.
#include "binding.h"

#include "inspect/path_view.h"
#include "inspect/settings.h"
#include "photons/map_columns.h"
#include "photons/nearest_query.h"
#include "settings.h"

namespace photonloupe::bindings {
namespace {

nb::dict describe_report(const Photons& photons) {
    const TraceReport& report = photons.report;
    const nb::dict flux = make_row("emitted"_a = report.flux_emitted, "deposited"_a = report.flux_deposited,
                                   "escaped"_a = report.flux_escaped, "truncated"_a = report.flux_truncated);
    return make_row("emitted"_a = report.emitted, "absorbed"_a = report.absorbed, "escaped"_a = report.escaped,
                    "truncated"_a = report.truncated, "ended_on_receiver"_a = report.ended_on_receiver,
                    "stored"_a = photons.map.count, "solid_angle"_a = report.solid_angle, "flux"_a = flux);
}

nb::dict describe_tree(Photons& photons, OpenDevice& open) {
    TreeArrays arrays = [&] {
        nb::gil_scoped_release release;
        return read_tree(*find_tree(open.device, photons));
    }();
    std::vector<float> boxes;
    for (const std::array<float, 6>& box : arrays.box)
        for (std::size_t i = 0; i < 6; ++i)
            boxes.push_back(static_cast<float>(box[i] + photons.map.origin[i % 3]));
    return make_row("split_axis"_a = own_array(std::move(arrays.split_axis)),
                    "split_value"_a = own_array(std::move(arrays.split_value)),
                    "first"_a = own_array(std::move(arrays.first)), "count"_a = own_array(std::move(arrays.count)),
                    "box"_a = own_array(std::move(boxes), 6), "order"_a = own_array(std::move(arrays.order)));
}

using Axes = std::vector<std::tuple<std::string, double, double, double>>; // name, low, high, period

std::vector<ParameterAxis> read_axes(const Axes& rows) {
    std::vector<ParameterAxis> axes;
    for (const auto& [name, low, high, period] : rows)
        axes.push_back({name, low, high, period});
    return axes;
}

Axes list_axes(const Photons& photons) {
    Axes rows;
    if (photons.map.parameters)
        for (const ParameterAxis& axis : photons.map.parameters->axes)
            rows.emplace_back(axis.name, axis.low, axis.high, axis.period);
    return rows;
}

// Columns by name, as they were checked; those that are absent are empty.
template <class T>
std::span<const T> take_span(const nb::dict& columns, const char* name) {
    if (!columns.contains(name))
        return {};
    const auto array = nb::cast<nb::ndarray<nb::numpy, const T, nb::c_contig>>(columns[name]);
    return {array.data(), array.size()};
}

std::vector<float> take_floats(const nb::dict& columns, const char* name) {
    const std::span<const float> values = take_span<float>(columns, name);
    return {values.begin(), values.end()};
}

std::shared_ptr<const RelaxedState> read_state(const nb::dict& columns) {
    for (const char* name : {"drift", "pressure", "constraint_basis", "constraint_weights", "gradient", "one_sidedness",
                             "traced_positions"})
        if (columns.contains(name))
            return std::make_shared<const RelaxedState>(
                RelaxedState{take_floats(columns, "traced_positions"), take_floats(columns, "drift"),
                             take_floats(columns, "pressure"), take_floats(columns, "constraint_basis"),
                             take_floats(columns, "constraint_weights"), take_floats(columns, "gradient"),
                             take_floats(columns, "one_sidedness")});
    return nullptr;
}

std::shared_ptr<Photons> make_photons(OpenDevice& open, const nb::dict& columns, const Axes& axes,
                                      const nb::dict& settings, std::uint64_t emitted) {
    auto photons = std::make_shared<Photons>();
    photons->map = make_map(
        open.device, {take_span<float>(columns, "positions"), take_span<float>(columns, "normals"),
                      take_span<float>(columns, "power"), take_span<std::int32_t>(columns, "emitter"),
                      take_span<std::uint64_t>(columns, "emitted_index"), take_span<std::int32_t>(columns, "object")});
    if (columns.contains("path_offsets"))
        photons->map.paths = make_paths(
            open.device,
            {take_span<std::int64_t>(columns, "path_offsets"), take_span<float>(columns, "path_vertices"),
             take_span<float>(columns, "path_normals"), take_span<std::uint8_t>(columns, "path_interactions"),
             take_span<std::int32_t>(columns, "path_objects"), take_span<float>(columns, "path_scatter")},
            photons->map.origin);
    set_parameters(open.device, *photons, take_floats(columns, "parameters"), read_axes(axes));
    if (columns.contains("colors"))
        set_colors(open.device, photons->map, take_floats(columns, "colors"));
    photons->state = read_state(columns);
    const auto origin = read_settings<TraceSettings>(settings);
    photons->store = origin.store;
    if (settings.contains("emission"))
        photons->emission = origin.emission;
    photons->report.emitted = emitted;
    return photons;
}

using Values = nb::ndarray<nb::numpy, const float, nb::ndim<2>, nb::c_contig>;
using Ids = nb::ndarray<nb::numpy, const std::uint32_t, nb::ndim<1>, nb::c_contig>;
using Points = nb::ndarray<nb::numpy, const double, nb::ndim<2>, nb::c_contig>;

// `points` are of world space, or, in parameter space, rows of all parameters.
nb::tuple find_near(OpenDevice& open, Photons& photons, std::optional<Points> points, std::optional<Ids> ids,
                    std::uint32_t k, const nb::dict& given, nb::object progress) {
    const auto take = [&](const char* name) {
        return given[name].is_none() ? std::vector<float>{} : nb::cast<std::vector<float>>(given[name]);
    };
    const std::vector<float> low = take("low"), high = take("high");
    const auto settings = read_settings<inspect::LoupeSettings>(given);
    NearestQuery query{.space = settings.space,
                       .k = k,
                       .beta = static_cast<float>(settings.beta),
                       .center = nb::cast<std::optional<std::uint32_t>>(given["center"]),
                       .low = low,
                       .high = high};
    if (ids)
        query.ids.emplace(ids->data(), ids->size());
    if (points)
        query.values = {points->data(), points->size()};
    std::vector<glm::vec4> places;
    if (query.space != SearchSpace::parameter)
        places = localize_points(photons.map, query.values);
    query.places = places;
    const Neighbors found = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return find_neighbors(open.device, photons, query, asked);
    });
    const std::size_t rows = points ? points->shape(0) : ids->size();
    return nb::make_tuple(own_array(found.ids.read<std::int32_t>(rows * k), k),
                          own_array(found.distances.read<float>(rows * k), k));
}

void give_parameters(OpenDevice& open, Photons& photons, const Values& values, const Axes& axes) {
    nb::gil_scoped_release release; // who builds a tree meanwhile may report to Python
    std::optional<ParameterColumns> made;
    if (std::vector<ParameterAxis> read = read_axes(axes); !read.empty())
        made = make_parameters(open.device, {values.data(), values.data() + values.size()}, std::move(read));
    const std::lock_guard lock(*photons.mutex);
    nb::gil_scoped_acquire acquire; // columns are read under it
    take_parameters(photons, std::move(made));
}

} // namespace

void bind_photons(nb::module_& module) {
    nb::class_<Photons> type(module, "PhotonMap");
    type.def_prop_ro("count", [](const Photons& photons) { return photons.map.count; })
        .def_prop_ro("emitted", [](const Photons& photons) { return photons.report.emitted; })
        .def_prop_ro("report", &describe_report)
        .def_prop_ro("axes", &list_axes, "Of the parameters: name, low, high, and a period, 0 where it does not wrap.")
        .def("tree", &describe_tree, "device"_a);
    bind_columns(type);
    module.def("photons_from_columns", &make_photons, "device"_a, "columns"_a, "axes"_a, "origin"_a, "emitted"_a,
               nb::keep_alive<0, 1>(),
               "Upload checked columns as a photon map; axes as of its parameters, origin: store and emission where "
               "they are known.");
    module.def(
        "share_photons", [](OpenDevice&, const Photons& photons) { return share_photons(photons); }, "device"_a,
        "photons"_a, nb::keep_alive<0, 1>(), nb::call_guard<nb::gil_scoped_release>(),
        "The same photons in the same memory, with parameters of their own.");
    module.def(
        "select_photons",
        [](OpenDevice& open, const Photons& photons, const Ids& ids) {
            return select_photons(open.device, photons, {ids.data(), ids.size()});
        },
        "device"_a, "photons"_a, "ids"_a, nb::keep_alive<0, 1>(), nb::call_guard<nb::gil_scoped_release>(),
        "Some photons, all columns.");
    module.def(
        "find_signature",
        [](const Photons& photons, const std::vector<std::uint8_t>& interactions) {
            return own_array(inspect::find_signature(photons.map, interactions));
        },
        "photons"_a, "interactions"_a,
        "Ids of the photons whose paths, which the map must have, went through just these.");
    module.def(
        "find_neighbors", &find_near, "device"_a, "photons"_a, "points"_a.none(), "ids"_a.none(), "k"_a, "query"_a,
        "progress"_a = nb::none(),
        "The k nearest photons of points, or of photons by id (n,); exactly one is not None. query: space, beta, "
        "center, low, high.");
    module.def("set_parameters", &give_parameters, "device"_a, "photons"_a, "values"_a, "axes"_a,
               "Replace a map's parameters (n, m).");
}

} // namespace photonloupe::bindings
