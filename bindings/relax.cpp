// SPDX-License-Identifier: Apache-2.0
// Binds engine/relax: a relaxation that is stepped, and what came of it as arrays.
#include "binding.h"

#include "relax/isotropy.h"
#include "relax/relaxation.h"
#include "settings.h"

namespace photonloupe::bindings {
namespace {

nb::dict describe_step(const StepReport& report) {
    return make_row("step"_a = report.step, "tau"_a = report.tau, "mean_move"_a = report.mean_move,
                    "largest_move"_a = report.largest_move, "mean_pressure"_a = report.mean_pressure,
                    "mean_displacement"_a = report.mean_metres, "flux_drift"_a = report.flux_drift);
}

using FoundBeta = std::optional<std::tuple<double, double, nb::ndarray<nb::numpy, float>>>;

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
    return describe_step(
        PythonProgress(std::move(progress)).run([&](const Progress& asked) { return open.relaxation.step(asked); }));
}

nb::tuple relax(OpenDevice& open, Photons& photons, nb::object scene, const nb::dict& given, nb::object progress) {
    const auto settings = read_settings<RelaxSettings>(given);
    const Scene* surface = scene.is_none() ? nullptr : nb::cast<const Scene*>(scene);
    const RelaxedRun run = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return open.workbench.relax_photons(photons, surface, settings, asked);
    });
    return nb::make_tuple(run.photons, describe_relaxation(run));
}

} // namespace

nb::dict describe_relaxation(const RelaxedRun& run) {
    RelaxSettings settings = run.settings;
    return make_row("settings"_a = write_rows(list_settings(settings)),
                    "steps"_a = list_rows(run.steps, &describe_step), "notes"_a = run.notes,
                    "off_surface"_a = run.off_surface_count);
}

void bind_relax(nb::module_& module) {
    nb::class_<OpenRelaxation>(module, "Relaxation")
        .def("step", &step, "progress"_a = nb::none(), "One step; what it did.")
        .def_prop_ro(
            "settings",
            [](const OpenRelaxation& open) {
                RelaxSettings settings = open.relaxation.settings();
                return write_rows(list_settings(settings));
            },
            "All of them, what is automatic filled in.")
        .def_prop_ro(
            "notes", [](const OpenRelaxation& open) { return open.relaxation.notes(); },
            "What makes parameters useless here, with the cure.")
        .def_prop_ro(
            "off_surface", [](const OpenRelaxation& open) { return open.relaxation.count_off_surface(); },
            "Photons that moved in their tangent plane.")
        .def(
            "read",
            [](const OpenRelaxation& open) {
                nb::gil_scoped_release release;
                return Workbench::take_relaxed(*open.photons, open.relaxation.read());
            },
            "The map as it is now.");
    module.def(
        "find_optimal_beta",
        [](OpenDevice& open, Photons& photons, std::uint32_t k, double clip, nb::object progress) -> FoundBeta {
            auto found = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
                return find_optimal_beta(open.device, photons, k, clip, asked);
            });
            if (!found)
                return std::nullopt;
            return std::tuple(found->beta, found->threshold, own_array(std::move(found->isotropy)));
        },
        "device"_a, "photons"_a, "k"_a, "clip"_a, "progress"_a = nb::none(),
        "β, t_β and the axis ratios (n,) they come from; None: no photon has one.");
    module.def(
        "explain_no_ratio", [](const Photons& photons) { return explain_no_ratio(photons.map); }, "photons"_a,
        "Why β cannot be found, and what to do.");
    module.def(
        "relax_photons", &relax, "device"_a, "photons"_a, "scene"_a.none(), "settings"_a, "progress"_a = nb::none(),
        "All steps of a relaxation: the map, and settings, steps, notes, off_surface; settings as start_relaxation.");
    module.def("start_relaxation", &start, "device"_a, "photons"_a, "scene"_a.none(), "settings"_a,
               "progress"_a = nb::none(), nb::keep_alive<0, 1>(),
               "Measure the constraint and stand ready; settings as describe_settings(\"relax\") has them.");
}

} // namespace photonloupe::bindings
