// SPDX-License-Identifier: Apache-2.0
// Binds a map's columns by their names as NumPy arrays: views where the memory is shared.
#include "binding.h"

#include "photons/map_columns.h"

namespace photonloupe::bindings {
namespace {

// A column; `read` may be called where `has` says so.
struct BoundColumn {
    const char* name;
    bool (*has)(const Photons&);
    nb::object (*read)(nb::handle self, const Photons&);
};

// A view of the first three floats of packed vec4s, kept alive by the map; a copy where memory is not shared.
nb::object view_rgb(nb::handle self, const gpu::Buffer& buffer, std::uint64_t count) {
    if (const void* memory = buffer.mapped()) {
        const std::size_t shape[2] = {count, 3};
        const std::int64_t strides[2] = {4, 1};
        return nb::cast(nb::ndarray<nb::numpy, const float>(memory, 2, shape, self, strides));
    }
    return nb::cast(own_array(read_vectors(buffer, count), 3));
}

// The same of places, which a view has where the map's origin is the world's.
nb::object view_places(nb::handle self, const PhotonMap& map, const gpu::Buffer& buffer, std::uint64_t count,
                       std::vector<float> (*read)(const PhotonMap&)) {
    if (map.origin == std::array<double, 3>{})
        return view_rgb(self, buffer, count);
    return nb::cast(own_array(read(map), 3));
}

nb::object share(const SharedFloats& column, std::size_t width) {
    return nb::cast(share_array(column, *column, {width}));
}

template <auto Field>
bool has_paths(const Photons& photons) {
    return photons.map.paths && photons.map.paths.value().*Field;
}

// A column of the state that has `Width` values a photon.
template <auto Field, std::size_t... Tail>
constexpr BoundColumn make_state_column(const char* name) {
    return {name,
            [](const Photons& photons) {
                return photons.state && (photons.state.get()->*Field).size() == (photons.map.count * ... * Tail);
            },
            [](nb::handle, const Photons& photons) {
                return nb::cast(share_array(photons.state, photons.state.get()->*Field, {Tail...}));
            }};
}

bool has_always(const Photons&) {
    return true;
}

bool has_any_paths(const Photons& photons) {
    return photons.map.paths.has_value();
}

constexpr BoundColumn COLUMNS[] = {
    {"positions", has_always,
     [](nb::handle self, const Photons& photons) {
         return view_places(self, photons.map, photons.map.position_emitter, photons.map.count, read_positions);
     }},
    {"normals", has_always,
     [](nb::handle self, const Photons& photons) {
         return view_rgb(self, photons.map.normal_index, photons.map.count);
     }},
    {"power", has_always,
     [](nb::handle self, const Photons& photons) {
         return view_rgb(self, photons.map.power_object, photons.map.count);
     }},
    {"emitter", has_always,
     [](nb::handle, const Photons& photons) { return nb::cast(own_array(read_emitters(photons.map))); }},
    {"emitted_index", has_always,
     [](nb::handle, const Photons& photons) { return nb::cast(own_array(read_emitted_indices(photons.map))); }},
    {"object", has_always,
     [](nb::handle, const Photons& photons) { return nb::cast(own_array(read_objects(photons.map))); }},
    {"path_offsets", has_any_paths,
     [](nb::handle, const Photons& photons) {
         return nb::cast(own_array(read_path_offsets(*photons.map.paths, photons.map.count)));
     }},
    {"path_vertices", has_any_paths,
     [](nb::handle self, const Photons& photons) {
         return view_places(self, photons.map, photons.map.paths->vertices, photons.map.paths->vertex_count,
                            [](const PhotonMap& map) { return read_path_vertices(*map.paths, map.origin); });
     }},
    {"path_normals", has_paths<&PathColumns::has_normals>,
     [](nb::handle self, const Photons& photons) {
         return view_rgb(self, photons.map.paths->normals, photons.map.paths->vertex_count);
     }},
    {"path_interactions", has_paths<&PathColumns::has_interactions>,
     [](nb::handle, const Photons& photons) {
         return nb::cast(own_array(read_path_interactions(*photons.map.paths)));
     }},
    {"path_objects", has_paths<&PathColumns::has_objects>,
     [](nb::handle, const Photons& photons) { return nb::cast(own_array(read_path_objects(*photons.map.paths))); }},
    {"path_scatter", has_paths<&PathColumns::has_scatter>,
     [](nb::handle, const Photons& photons) { return nb::cast(own_array(read_path_scatter(*photons.map.paths))); }},
    {"parameters", [](const Photons& photons) { return photons.map.parameters.has_value(); },
     [](nb::handle, const Photons& photons) {
         return share(photons.map.parameters->given, photons.map.parameters->count);
     }},
    {"colors", [](const Photons& photons) { return photons.map.given_colors != nullptr; },
     [](nb::handle, const Photons& photons) { return share(photons.map.given_colors, 3); }},
    make_state_column<&RelaxedState::basis, 2, 3>("constraint_basis"),
    make_state_column<&RelaxedState::weights, 2>("constraint_weights"),
    make_state_column<&RelaxedState::gradient, 3>("gradient"),
    make_state_column<&RelaxedState::one_sidedness>("one_sidedness"),
    make_state_column<&RelaxedState::traced, 3>("traced_positions"),
    make_state_column<&RelaxedState::drift, 3>("drift"),
    make_state_column<&RelaxedState::pressure>("pressure"),
};

std::vector<std::string> list_names(const Photons& photons) {
    std::vector<std::string> names;
    for (const BoundColumn& column : COLUMNS)
        if (column.has(photons))
            names.emplace_back(column.name);
    return names;
}

nb::object read_column(nb::handle self, const std::string& name) {
    const auto& photons = nb::cast<const Photons&>(self);
    for (const BoundColumn& column : COLUMNS)
        if (column.name == name && column.has(photons))
            return column.read(self, photons);
    return nb::none();
}

} // namespace

void bind_columns(nb::class_<Photons>& type) {
    type.def_prop_ro("names", &list_names, "Of the columns there are.")
        .def("column", &read_column, "name"_a, "The column, read-only; None: there is none.");
}

} // namespace photonloupe::bindings
