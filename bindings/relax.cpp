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

nb::dict describe_step(const StepReport& report) {
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

nb::dict step(OpenRelaxation& open, nb::object progress) {
    return describe_step(
        PythonProgress(std::move(progress)).run([&](const Progress& asked) { return open.relaxation.step(asked); }));
}

nb::tuple relax(OpenDevice& open, Photons& photons, nb::object scene, const nb::dict& given, nb::object progress) {
    const auto settings = read_settings<RelaxSettings>(given);
    const Scene* surface = scene.is_none() ? nullptr : nb::cast<const Scene*>(scene);
    const RelaxedRun run = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return open.workbench.relax_photons(photons, surface, settings, asked);
    });
    nb::list rows;
    for (const StepReport& report : run.steps)
        rows.append(describe_step(report));
    return nb::make_tuple(run.photons, rows, run.notes, run.off_surface_count);
}

} // namespace

void bind_relax(nb::module_& module) {
    nb::class_<OpenRelaxation>(module, "Relaxation")
        .def("step", &step, nb::arg("progress").none() = nb::none(), "One step; what it did.")
        .def_prop_ro(
            "notes", [](const OpenRelaxation& open) { return open.relaxation.notes(); },
            "What makes parameters useless here, with the cure.")
        .def_prop_ro(
            "off_surface", [](const OpenRelaxation& open) { return open.relaxation.count_off_surface(); },
            "Photons that moved in their tangent plane.")
        .def(
            "sample_distances",
            [](const OpenRelaxation& open, std::uint64_t count, std::uint32_t k) {
                std::vector<float> distances = PythonProgress(nb::none()).run([&](const Progress& asked) {
                    return open.relaxation.sample_distances(count, k, asked);
                });
                return own_array(std::move(distances), k);
            },
            nb::arg("count"), nb::arg("k"),
            "Distances (m, k) of photons spread evenly over the map to their nearest, where they are now.")
        .def(
            "read",
            [](const OpenRelaxation& open) {
                nb::gil_scoped_release release;
                return Workbench::take_relaxed(*open.photons, open.relaxation.read());
            },
            "The map as it is now.");
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
    module.def("relax_photons", &relax, nb::arg("device"), nb::arg("photons"), nb::arg("scene").none(),
               nb::arg("settings"), nb::arg("progress").none() = nb::none(),
               "All steps of a relaxation: the map, what each step did, notes, photons off their surface; settings as "
               "start_relaxation.");
    module.def("start_relaxation", &start, nb::arg("device"), nb::arg("photons"), nb::arg("scene").none(),
               nb::arg("settings"), nb::arg("progress").none() = nb::none(), nb::keep_alive<0, 1>(),
               "Measure the constraint and stand ready; settings as describe_settings(\"relax\") has them.");
}

} // namespace photonloupe::bindings
