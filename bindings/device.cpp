// SPDX-License-Identifier: Apache-2.0
// Binds engine/gpu: devices, their self-test and timings.
#include "binding.h"

#include "gpu/compile_ahead.h"
#include "gpu/self_test.h"

namespace photonloupe::bindings {
namespace {

nb::dict describe(const gpu::DeviceInfo& info) {
    nb::dict row;
    row["index"] = info.index;
    row["name"] = info.name;
    row["type"] = info.type;
    row["driver"] = info.driver;
    row["api_version"] = info.api_version;
    row["memory"] = info.memory_bytes;
    row["usable"] = info.usable;
    row["reason"] = info.reason;
    return row;
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
    nb::list rows;
    for (const auto& [stage, timing] : open.device.take_timings()) {
        nb::dict row;
        row["stage"] = stage;
        row["milliseconds"] = timing.milliseconds;
        row["dispatches"] = timing.dispatch_count;
        rows.append(row);
    }
    return rows;
}

} // namespace

void bind_device(nb::module_& module) {
    module.def(
        "list_devices",
        [] {
            nb::list rows;
            for (const gpu::DeviceInfo& info : gpu::list_devices())
                rows.append(describe(info));
            return rows;
        },
        "Every Vulkan device of this machine.");
    nb::class_<OpenDevice>(module, "Device")
        .def(nb::init<const std::string&>(), nb::arg("selector") = "auto")
        .def_prop_ro("info", &describe_open)
        .def("self_test",
             [](OpenDevice& open) {
                 const gpu::SelfTest test = gpu::run_self_test(open.device);
                 nb::dict row;
                 row["ok"] = test.ok;
                 row["milliseconds"] = test.milliseconds;
                 row["message"] = test.message;
                 return row;
             })
        .def(
            "forget", [](OpenDevice& open) { open.workbench.forget(); },
            "All stages run again, whatever they are asked.")
        .def("timings", &list_timings);
    // Before the interpreter goes, as it may leave devices behind.
    nb::module_::import_("atexit").attr("register")(nb::cpp_function([] { gpu::CompileAhead::stop_all(); }));
}

} // namespace photonloupe::bindings
