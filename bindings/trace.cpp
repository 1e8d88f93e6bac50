// SPDX-License-Identifier: Apache-2.0
// Binds engine/trace: settings in, a photon map with its account out.
#include "binding.h"

#include "settings.h"

namespace photonloupe::bindings {
void bind_trace(nb::module_& module) {
    module.def(
        "trace_photons",
        [](OpenDevice& open, const Scene& scene, const nb::dict& given, nb::object progress) {
            auto settings = read_settings<TraceSettings>(given);
            settings.paths = nb::cast<bool>(given["paths"]);
            return PythonProgress(std::move(progress)).run([&](const Progress& asked) {
                return open.workbench.trace_photons(scene, settings, asked);
            });
        },
        nb::arg("device"), nb::arg("scene"), nb::arg("settings"), nb::arg("progress").none() = nb::none(),
        nb::keep_alive<0, 1>(), "Trace photons; settings as describe_settings(\"trace\") has them, and paths.");
    module.def(
        "record_paths",
        [](OpenDevice& open, Photons& photons, const Scene& scene, const nb::dict& given, nb::object progress) {
            const auto settings = read_settings<TraceSettings>(given);
            PythonProgress(std::move(progress)).run([&](const Progress& asked) {
                open.workbench.record_paths(photons, scene, settings, asked);
            });
        },
        nb::arg("device"), nb::arg("photons"), nb::arg("scene"), nb::arg("settings"),
        nb::arg("progress").none() = nb::none(), "Give traced photons their paths, by tracing them again.");
}

} // namespace photonloupe::bindings
