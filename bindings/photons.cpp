// SPDX-License-Identifier: Apache-2.0
// Binds engine/photons: columns as NumPy arrays (views where the memory is shared), the tree, neighbours.
#include "binding.h"

#include "inspect/settings.h"
#include "photons/map_columns.h"
#include "settings.h"

namespace photonloupe::bindings {
namespace {

// A view of the first three floats of packed vec4s, kept alive by the map; a copy where memory is not shared.
nb::object view_rgb(nb::handle self, const gpu::Buffer& buffer, std::uint64_t count) {
    if (const void* memory = buffer.mapped()) {
        const std::size_t shape[2] = {count, 3};
        const std::int64_t strides[2] = {4, 1};
        return nb::cast(nb::ndarray<nb::numpy, const float>(memory, 2, shape, self, strides));
    }
    std::vector<float> values;
    for (const glm::vec4& packed : buffer.read<glm::vec4>(count))
        values.insert(values.end(), {packed.x, packed.y, packed.z});
    return nb::cast(own_array(std::move(values), 3));
}

bool is_at_origin(const PhotonMap& map) {
    return map.origin == std::array<double, 3>{};
}

const Photons& unwrap(nb::handle self) {
    return nb::cast<const Photons&>(self);
}

nb::object view_positions(nb::handle self) {
    const PhotonMap& map = unwrap(self).map;
    return is_at_origin(map) ? view_rgb(self, map.position_emitter, map.count)
                             : nb::cast(own_array(read_positions(map), 3));
}

nb::object view_path_vertices(nb::handle self) {
    const PhotonMap& map = unwrap(self).map;
    if (!map.paths)
        return nb::none();
    return is_at_origin(map) ? view_rgb(self, map.paths->vertices, map.paths->vertex_count)
                             : nb::cast(own_array(read_path_vertices(*map.paths, map.origin), 3));
}

nb::object read_scatter(const PathColumns& paths) {
    std::vector<float> values;
    for (const glm::vec4& normal : paths.normals.read<glm::vec4>(paths.vertex_count))
        values.push_back(normal.w);
    return nb::cast(own_array(std::move(values)));
}

nb::dict describe_report(const Photons& photons) {
    const TraceReport& report = photons.report;
    nb::dict flux;
    flux["emitted"] = report.flux_emitted;
    flux["deposited"] = report.flux_deposited;
    flux["escaped"] = report.flux_escaped;
    flux["truncated"] = report.flux_truncated;
    nb::dict row;
    row["emitted"] = report.emitted;
    row["absorbed"] = report.absorbed;
    row["escaped"] = report.escaped;
    row["truncated"] = report.truncated;
    row["ended_on_receiver"] = report.ended_on_receiver;
    row["stored"] = photons.map.count;
    row["solid_angle"] = report.solid_angle;
    row["flux"] = flux;
    return row;
}

nb::dict describe_tree(Photons& photons, Workbench& workbench) {
    TreeArrays arrays = read_tree(workbench.find_tree(photons));
    std::vector<float> boxes;
    for (const std::array<float, 6>& box : arrays.box)
        for (std::size_t i = 0; i < 6; ++i)
            boxes.push_back(static_cast<float>(box[i] + photons.map.origin[i % 3]));
    nb::dict row;
    row["split_axis"] = own_array(std::move(arrays.split_axis));
    row["split_value"] = own_array(std::move(arrays.split_value));
    row["first"] = own_array(std::move(arrays.first));
    row["count"] = own_array(std::move(arrays.count));
    row["box"] = own_array(std::move(boxes), 6);
    row["order"] = own_array(std::move(arrays.order));
    return row;
}

template <class T>
std::span<const T> take_span(const nb::dict& columns, const char* name) {
    const auto array = nb::cast<nb::ndarray<nb::numpy, const T, nb::c_contig>>(columns[name]);
    return {array.data(), array.size()};
}

std::shared_ptr<Photons> make_photons(OpenDevice& open, const nb::dict& columns, const std::string& store) {
    const MapColumns spans{take_span<float>(columns, "positions"),
                           take_span<float>(columns, "normals"),
                           take_span<float>(columns, "power"),
                           take_span<std::int32_t>(columns, "emitter"),
                           take_span<std::uint64_t>(columns, "emitted_index"),
                           take_span<std::int32_t>(columns, "object")};
    auto photons = std::make_shared<Photons>();
    photons->map = make_map(open.device, spans);
    TraceSettings origin;
    write_setting(find_setting(list_settings(origin), "store"), store);
    photons->store = origin.store;
    return photons;
}

nb::tuple take_neighbors(const Neighbors& neighbors, std::size_t rows, std::uint32_t k) {
    return nb::make_tuple(own_array(neighbors.ids.read<std::int32_t>(rows * k), k),
                          own_array(neighbors.distances.read<float>(rows * k), k));
}

using Ids = nb::ndarray<nb::numpy, const std::uint32_t, nb::ndim<1>, nb::c_contig>;
using Points = nb::ndarray<nb::numpy, const double, nb::ndim<2>, nb::c_contig>;

// `points` are of world space, or, in parameter space, rows of all parameters.
Neighbors find_in_space(OpenDevice& open, Photons& photons, std::span<const double> points,
                        std::span<const std::uint32_t> ids, bool has_points, std::uint32_t k, inspect::LoupeSpace space,
                        float beta, std::int64_t center, const std::vector<float>& low, const std::vector<float>& high,
                        const Progress& asked) {
    Workbench& bench = open.workbench;
    if (space == inspect::LoupeSpace::parameter)
        return has_points ? bench.find_parameter_neighbors(photons, points, k, asked)
                          : bench.find_parameter_neighbors_of(photons, ids, k, asked);
    if (!has_points)
        return space == inspect::LoupeSpace::world ? bench.find_neighbors_of(photons, ids, k, asked)
                                                   : bench.find_layer_neighbors_of(photons, ids, k, beta, asked);
    const std::vector<glm::vec4> local = localize_points(photons.map, points);
    if (space == inspect::LoupeSpace::world)
        return bench.find_neighbors(photons, local, k, asked);
    if (center >= 0)
        return bench.find_layer_neighbors(photons, local, static_cast<std::uint32_t>(center), k, beta, asked);
    return bench.find_range_neighbors(photons, local, low, high, k, asked);
}

nb::tuple find_near(OpenDevice& open, Photons& photons, std::optional<Points> points, std::optional<Ids> ids,
                    std::uint32_t k, const nb::dict& query, nb::object progress) {
    const auto settings = read_settings<inspect::LoupeSettings>(query);
    const inspect::LoupeSpace space = settings.space;
    const auto beta = static_cast<float>(settings.beta);
    const auto center = nb::cast<std::int64_t>(query["center"]);
    const auto take = [&](const char* name) {
        return query[name].is_none() ? std::vector<float>{} : nb::cast<std::vector<float>>(query[name]);
    };
    const std::vector<float> low = take("low"), high = take("high");
    const std::span<const double> values =
        points ? std::span(points->data(), points->size()) : std::span<const double>{};
    const std::span<const std::uint32_t> named =
        ids ? std::span(ids->data(), ids->size()) : std::span<const std::uint32_t>{};
    const Neighbors found = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return find_in_space(open, photons, values, named, points.has_value(), k, space, beta, center, low, high,
                             asked);
    });
    return take_neighbors(found, points ? points->shape(0) : ids->size(), k);
}

void set_parameters(OpenDevice& open, Photons& photons,
                    nb::ndarray<nb::numpy, const float, nb::ndim<2>, nb::c_contig> values, const nb::list& rows) {
    std::vector<ParameterAxis> axes;
    for (nb::handle row : rows)
        axes.push_back({nb::cast<std::string>(row["name"]), nb::cast<float>(row["low"]), nb::cast<float>(row["high"]),
                        nb::cast<float>(row["period"])});
    photons.forget_parameters();
    photons.map.parameters = make_parameters(open.device, {values.data(), values.size()}, std::move(axes));
}

// What a map from a file, or a part of another map, was relaxed with; columns that are absent stay empty.
void set_state(Photons& photons, const nb::dict& columns) {
    auto state = std::make_shared<RelaxedState>();
    const auto take = [&](const char* name, std::vector<float>& target) {
        if (!columns.contains(name))
            return;
        const std::span<const float> values = take_span<float>(columns, name);
        target.assign(values.begin(), values.end());
    };
    take("drift", state->drift);
    take("pressure", state->pressure);
    take("constraint_basis", state->basis);
    take("constraint_weights", state->weights);
    take("gradient", state->gradient);
    take("one_sidedness", state->one_sidedness);
    photons.state = std::move(state);
}

// Columns that are absent stay empty.
void set_paths(OpenDevice& open, Photons& photons, const nb::dict& columns) {
    const auto take = [&]<class T>(const char* name, T) {
        return columns.contains(name) ? take_span<T>(columns, name) : std::span<const T>{};
    };
    const PathArrays arrays{take("path_offsets", std::int64_t{}), take("path_vertices", 0.0f),
                            take("path_normals", 0.0f),           take("path_interactions", std::uint8_t{}),
                            take("path_objects", std::int32_t{}), take("path_scatter", 0.0f)};
    photons.map.paths = make_paths(open.device, arrays, photons.map.origin);
}

// Rows of NaN: the photon has none.
void set_colors(OpenDevice& open, Photons& photons,
                nb::ndarray<nb::numpy, const float, nb::shape<-1, 3>, nb::c_contig> values) {
    photons.map.colors = make_colors(open.device, {values.data(), values.size()});
}

// A column of the paths, or None when they were not recorded.
template <class Read>
auto path_column(const Read& read) {
    return [read](nb::handle self) -> nb::object {
        const PhotonMap& map = unwrap(self).map;
        return map.paths ? nb::object(nb::cast(read(self, map))) : nb::none();
    };
}

void bind_columns(nb::class_<Photons>& type) {
    type.def_prop_ro("positions", &view_positions)
        .def_prop_ro(
            "normals",
            [](nb::handle self) { return view_rgb(self, unwrap(self).map.normal_index, unwrap(self).map.count); })
        .def_prop_ro(
            "power",
            [](nb::handle self) { return view_rgb(self, unwrap(self).map.power_object, unwrap(self).map.count); })
        .def_prop_ro(
            "emitter", [](const Photons& photons) { return own_array(read_emitters(photons.map)); },
            nb::rv_policy::move)
        .def_prop_ro(
            "emitted_index", [](const Photons& photons) { return own_array(read_emitted_indices(photons.map)); },
            nb::rv_policy::move)
        .def_prop_ro(
            "object", [](const Photons& photons) { return own_array(read_objects(photons.map)); }, nb::rv_policy::move)
        .def_prop_ro("path_vertices", &view_path_vertices)
        .def_prop_ro("path_offsets", path_column([](nb::handle, const PhotonMap& map) {
                         return own_array(read_path_offsets(*map.paths, map.count));
                     }))
        .def_prop_ro("path_normals", path_column([](nb::handle self, const PhotonMap& map) {
                         return view_rgb(self, map.paths->normals, map.paths->vertex_count);
                     }))
        .def_prop_ro("path_interactions", path_column([](nb::handle, const PhotonMap& map) {
                         return own_array(read_path_interactions(*map.paths));
                     }))
        .def_prop_ro("path_objects", path_column([](nb::handle, const PhotonMap& map) {
                         return own_array(read_path_objects(*map.paths));
                     }))
        .def_prop_ro("path_scatter",
                     path_column([](nb::handle, const PhotonMap& map) { return read_scatter(*map.paths); }));
}

} // namespace

void bind_photons(nb::module_& module) {
    nb::class_<Photons> type(module, "PhotonMap");
    type.def_prop_ro("count", [](const Photons& photons) { return photons.map.count; })
        .def_prop_ro("emitted", [](const Photons& photons) { return photons.report.emitted; })
        .def_prop_ro("origin", [](const Photons& photons) { return photons.map.origin; })
        .def_prop_ro("report", &describe_report)
        .def(
            "tree", [](Photons& photons, OpenDevice& open) { return describe_tree(photons, open.workbench); },
            nb::arg("device"));
    bind_columns(type);
    module.def("photons_from_columns", &make_photons, nb::arg("device"), nb::arg("columns"),
               nb::arg("store") = "caustic", nb::keep_alive<0, 1>(), "Upload checked columns as a photon map.");
    module.def(
        "find_neighbors", &find_near, nb::arg("device"), nb::arg("photons"), nb::arg("points").none(),
        nb::arg("ids").none(), nb::arg("k"), nb::arg("query"), nb::arg("progress").none() = nb::none(),
        "The k nearest photons of points, or of photons by id (n,); exactly one is not None. query: space, beta, "
        "center, low, high.");
    module.def("set_parameters", &set_parameters, nb::arg("device"), nb::arg("photons"), nb::arg("values"),
               nb::arg("axes"),
               "Replace a map's parameters (n, m); of each: name, low, high, and a period, 0 where it does not wrap.");
    module.def("set_state", &set_state, nb::arg("photons"), nb::arg("columns"),
               "Give a map the checked columns that a relaxation left.");
    module.def("set_paths", &set_paths, nb::arg("device"), nb::arg("photons"), nb::arg("columns"),
               "Give a map the checked path columns of its photons.");
    module.def("set_colors", &set_colors, nb::arg("device"), nb::arg("photons"), nb::arg("values"),
               "Replace a map's false colors (n, 3); NaN: none, shown in grey.");
}

} // namespace photonloupe::bindings
