// SPDX-License-Identifier: Apache-2.0
// Binds engine/trace: settings in, a photon map with its account out.
#include "binding.h"

#include "choices.h"

namespace photonloupe::bindings {
namespace {

TraceSettings read_settings(const nb::dict& given) {
    TraceSettings settings;
    settings.count = nb::cast<std::uint64_t>(given["count"]);
    settings.emitted = nb::cast<std::uint64_t>(given["emitted"]);
    settings.seed = nb::cast<std::uint32_t>(given["seed"]);
    settings.emission = parse_emission(nb::cast<std::string>(given["emission"]));
    settings.store = parse_store(nb::cast<std::string>(given["store"]));
    settings.max_bounces = nb::cast<std::uint32_t>(given["max_bounces"]);
    settings.paths = nb::cast<bool>(given["paths"]);
    return settings;
}

} // namespace

void bind_trace(nb::module_& module) {
    module.def(
        "trace_photons",
        [](OpenDevice& open, const Scene& scene, const nb::dict& given, nb::object progress) {
            const TraceSettings settings = read_settings(given);
            return PythonProgress(std::move(progress)).run([&](const Progress& asked) {
                return open.workbench.trace_photons(scene, settings, asked);
            });
        },
        nb::arg("device"), nb::arg("scene"), nb::arg("settings"), nb::arg("progress").none() = nb::none(),
        nb::keep_alive<0, 1>(), "Trace photons; settings: count, emitted, seed, emission, store, max_bounces, paths.");
    module.def(
        "record_paths",
        [](OpenDevice& open, Photons& photons, const Scene& scene, const nb::dict& given, nb::object progress) {
            const TraceSettings settings = read_settings(given);
            PythonProgress(std::move(progress)).run([&](const Progress& asked) {
                open.workbench.record_paths(photons, scene, settings, asked);
            });
        },
        nb::arg("device"), nb::arg("photons"), nb::arg("scene"), nb::arg("settings"),
        nb::arg("progress").none() = nb::none(), "Give traced photons their paths, by tracing them again.");
}

} // namespace photonloupe::bindings
