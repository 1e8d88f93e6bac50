// SPDX-License-Identifier: Apache-2.0
// The extension module: exceptions, version, and one call per engine folder.
#include "binding.h"

#include "core/error.h"

NB_MODULE(_engine, module) {
    using namespace photonloupe;
    module.doc() = "Photon Loupe's engine: tracing, photon maps, estimation on Vulkan compute.";
    module.attr("version") = PHOTONLOUPE_VERSION;
    auto base = nb::exception<Error>(module, "PhotonLoupeError");
    nb::exception<ArgumentError>(module, "ArgumentError", nb::make_tuple(base, nb::handle(PyExc_ValueError)));
    nb::exception<SceneError>(module, "SceneError", base);
    nb::exception<DeviceError>(module, "DeviceError", base);
    nb::exception<MemoryError>(module, "DeviceMemoryError", base);
    nb::exception<Cancelled>(module, "Cancelled", base);
    bindings::bind_settings(module);
    bindings::bind_device(module);
    bindings::bind_scene(module);
    bindings::bind_photons(module);
    bindings::bind_trace(module);
    bindings::bind_script(module);
    bindings::bind_relax(module);
    bindings::bind_estimate(module);
    bindings::bind_image(module);
    bindings::bind_inspect(module);
    bindings::bind_inspect_images(module);
    bindings::bind_parallel_coordinates(module);
    bindings::bind_studio(module);
}
