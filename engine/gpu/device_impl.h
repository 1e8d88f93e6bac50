// SPDX-License-Identifier: Apache-2.0
// What a Device owns; shared by the files of engine/gpu and by no one else.
#pragma once

#include <atomic>
#include <unordered_map>

#include "gpu/compile_ahead.h"
#include "gpu/device.h"
#include "gpu/instance.h"
#include "gpu/kernel.h"
#include "gpu/turn_mutex.h"
#include "gpu/vulkan_api.h"

namespace photonloupe::gpu {

// Long enough to amortise a submission (80 µs), short enough to stop within 0.2 s of Ctrl-C.
constexpr double CHUNK_MILLISECONDS = 40.0;

struct Device::Impl {
    std::shared_ptr<Instance> instance; // shared by all devices of the process: Vulkan allows one debug messenger each
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VolkDeviceTable table{};
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    VkCommandPool command_pool = VK_NULL_HANDLE;
    VkPipelineCache pipeline_cache = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memory{};
    DeviceInfo info;
    DeviceLimits limits;
    std::string chosen_because;
    std::string lost_because;         // set once a wait has failed; every later use refuses with it
    bool fixes_subgroup_size = false; // pipelines must ask for limits.subgroup_size
    std::uint32_t memory_type_main = 0;
    std::uint32_t memory_type_staging = 0;
    std::atomic<std::uint64_t> allocated_bytes = 0;
    double timestamp_nanoseconds = 0; // per tick; 0: the queue has no timestamps
    std::mutex kernels_mutex;
    std::unordered_map<std::string, std::unique_ptr<Kernel>> kernels; // by make_key()
    std::unique_ptr<CompileAhead> ahead;
    bool is_rehearsal = false; // opened to compile: what validation says is for the device that is used to report
    std::map<std::string, StageTiming> timings;
    std::atomic<double> chunk_milliseconds = CHUNK_MILLISECONDS;
    TurnMutex mutex; // one queue: work of several threads is taken in turn

    void require_alive() const;
    ~Impl();
};

} // namespace photonloupe::gpu
