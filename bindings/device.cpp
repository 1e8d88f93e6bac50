// SPDX-License-Identifier: Apache-2.0
// Binds engine/gpu: devices, their self-test and timings.
#include "binding.h"

#include "gpu/compile_ahead.h"
#include "gpu/self_test.h"

namespace photonloupe::bindings {
namespace {

nb::dict describe(const gpu::DeviceInfo& info) {
    return make_row("index"_a = info.index, "name"_a = info.name, "type"_a = info.type, "driver"_a = info.driver,
                    "api_version"_a = info.api_version, "memory"_a = info.memory_bytes, "usable"_a = info.usable,
                    "reason"_a = info.reason);
}

nb::dict describe_open(const OpenDevice& open) {
    nb::dict row = describe(open.device.info());
    row["chosen_because"] = open.device.chosen_because();
    row["validation"] = open.device.validation_mode();
    row["subgroup_size"] = open.device.limits().subgroup_size;
    row["allocated"] = open.device.allocated_bytes();
    row["available"] = open.device.available_bytes();
    return row;
}

nb::list list_timings(OpenDevice& open) {
    return list_rows(open.device.take_timings(), [](const auto& taken) {
        const auto& [stage, timing] = taken;
        return make_row("stage"_a = stage, "milliseconds"_a = timing.milliseconds,
                        "dispatches"_a = timing.dispatch_count);
    });
}

} // namespace

void bind_device(nb::module_& module) {
    module.def(
        "list_devices", [] { return list_rows(gpu::list_devices(), &describe); },
        "Every Vulkan device of this machine.");
    nb::class_<OpenDevice>(module, "Device")
        .def(nb::init<const std::string&>(), "selector"_a = "auto")
        .def_prop_ro("info", &describe_open)
        .def("self_test",
             [](OpenDevice& open) {
                 const gpu::SelfTest test = gpu::run_self_test(open.device);
                 return make_row("ok"_a = test.ok, "milliseconds"_a = test.milliseconds, "message"_a = test.message);
             })
        .def(
            "forget", [](OpenDevice& open) { open.workbench.forget(); },
            "All stages run again, whatever they are asked.")
        .def("timings", &list_timings);
    // Before the interpreter goes, as it may leave devices behind.
    nb::module_::import_("atexit").attr("register")(nb::cpp_function([] { gpu::CompileAhead::stop_all(); }));
}

} // namespace photonloupe::bindings
