// SPDX-License-Identifier: Apache-2.0
// Binds engine/relax: a relaxation that is stepped, and what came of it as arrays.
#include "binding.h"

#include "relax/relaxation.h"
#include "settings.h"

namespace photonloupe::bindings {
namespace {

// A relaxation with the photons it reads from.
struct OpenRelaxation {
    std::shared_ptr<Photons> photons;
    Relaxation relaxation;
};

std::shared_ptr<OpenRelaxation> start(OpenDevice& open, std::shared_ptr<Photons> photons, nb::object scene,
                                      const nb::dict& given, nb::object progress) {
    const auto settings = read_settings<RelaxSettings>(given);
    const Scene* surface = scene.is_none() ? nullptr : nb::cast<const Scene*>(scene);
    return PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return std::make_shared<OpenRelaxation>(
            OpenRelaxation{photons, open.workbench.start_relaxation(*photons, surface, settings, asked)});
    });
}

nb::dict step(OpenRelaxation& open, nb::object progress) {
    const StepReport report =
        PythonProgress(std::move(progress)).run([&](const Progress& asked) { return open.relaxation.step(asked); });
    nb::dict row;
    row["step"] = report.step;
    row["tau"] = report.tau;
    row["mean_move"] = report.mean_move;
    row["largest_move"] = report.largest_move;
    row["mean_pressure"] = report.mean_pressure;
    row["mean_displacement"] = report.mean_metres;
    row["flux_drift"] = report.flux_drift;
    return row;
}

// The map with its new places, and the state columns by name; those that were not measured are left out.
nb::tuple read(OpenRelaxation& open) {
    RelaxedColumns columns = open.relaxation.read();
    const bool has_constraint = columns.has_constraint;
    const std::uint64_t off_surface_count = columns.off_surface_count;
    const std::shared_ptr<Photons> photons = Workbench::take_relaxed(*open.photons, std::move(columns));
    const std::shared_ptr<const RelaxedState> state = photons->state;
    nb::dict arrays;
    arrays["drift"] = share_array(state, state->drift, {3});
    arrays["pressure"] = share_array(state, state->pressure, {});
    if (has_constraint) {
        arrays["constraint_basis"] = share_array(state, state->basis, {2, 3});
        arrays["constraint_weights"] = share_array(state, state->weights, {2});
        arrays["gradient"] = share_array(state, state->gradient, {3});
        arrays["one_sidedness"] = share_array(state, state->one_sidedness, {});
    }
    return nb::make_tuple(photons, arrays, off_surface_count);
}

} // namespace

void bind_relax(nb::module_& module) {
    nb::class_<OpenRelaxation>(module, "Relaxation")
        .def("step", &step, nb::arg("progress").none() = nb::none(), "One step; what it did.")
        .def_prop_ro(
            "notes", [](const OpenRelaxation& open) { return open.relaxation.notes(); },
            "What makes parameters useless here, with the cure.")
        .def("read", &read, "(map, state columns by photon id, photons off their surface).");
    module.def(
        "measure_isotropy",
        [](OpenDevice& open, Photons& photons, std::uint32_t k, nb::object progress) {
            std::vector<float> ratios = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
                return open.workbench.measure_isotropy(photons, k, asked);
            });
            return own_array(std::move(ratios));
        },
        nb::arg("device"), nb::arg("photons"), nb::arg("k"), nb::arg("progress").none() = nb::none(),
        "Axis ratios (n,) of the world positions of each photon's k neighbours in parameter space; NaN: none.");
    module.def("start_relaxation", &start, nb::arg("device"), nb::arg("photons"), nb::arg("scene").none(),
               nb::arg("settings"), nb::arg("progress").none() = nb::none(), nb::keep_alive<0, 1>(),
               "Measure the constraint and stand ready; settings as describe_settings(\"relax\") has them.");
}

} // namespace photonloupe::bindings
