// SPDX-License-Identifier: Apache-2.0
// One Vulkan compute device: which there are, which was chosen and why, what it allows, what it has used.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace photonloupe::gpu {

class Kernel;
struct KernelSource;

// What the Vulkan loader reports about one physical device.
struct DeviceInfo {
    int index = 0;
    std::string name;
    std::string type; // "discrete", "integrated", "virtual", "software", "other"
    std::string driver;
    std::string api_version;
    std::uint64_t memory_bytes = 0;
    bool usable = false;
    std::string reason; // why it is not usable; empty otherwise
};

// Limits that decide how kernels are built and work is cut.
struct DeviceLimits {
    std::uint32_t subgroup_size = 0;
    std::uint64_t max_storage_range = 0;    // bytes one descriptor may cover; larger buffers go by address
    std::uint64_t max_allocation_bytes = 0; // of one buffer
    std::uint64_t max_texel_count = 0;      // of one texel buffer
    std::uint32_t max_group_count = 0;      // workgroups in x
    bool host_visible = false;              // buffers are read and written in place, without staging
    bool can_draw = false;                  // the interface
    bool can_present = false;               // in a window
};

// Time one stage has spent on the device since the timings were last taken.
struct StageTiming {
    double milliseconds = 0;
    std::uint64_t dispatch_count = 0;
};

// All devices the loader reports. Throws DeviceError when there is no Vulkan loader.
std::vector<DeviceInfo> list_devices();

class Device {
public:
    // selector: "auto" (first discrete GPU, else integrated, else software), an index, or part of a name.
    explicit Device(const std::string& selector = "auto");
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const;
    const DeviceLimits& limits() const;
    const std::string& chosen_because() const;
    std::string validation_mode() const; // "", "core" or "sync"

    // Bytes of this device's buffers, and what could still be allocated.
    std::uint64_t allocated_bytes() const;
    std::uint64_t available_bytes() const;

    // How long a chunk of long work aims to take: shorter while someone watches and frames wait for the same queue.
    void set_chunk_milliseconds(double milliseconds);
    double chunk_milliseconds() const;

    // The compiled kernel for a source, built at first request and kept.
    Kernel& find_kernel(const KernelSource& source);
    // Compiles kernels in background threads, in this order and before what already waits; returns at once. One that is
    // needed before is waited for or compiled where it is needed. What fails is reported by its first use.
    void compile_ahead(const std::vector<KernelSource>& sources);

    void record_timing(const std::string& stage, double milliseconds, std::uint64_t dispatch_count);
    std::map<std::string, StageTiming> take_timings();

    struct Impl;
    Impl& impl() { return *m_impl; }

private:
    std::unique_ptr<Impl> m_impl;
};

} // namespace photonloupe::gpu
