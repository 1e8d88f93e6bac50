// SPDX-License-Identifier: Apache-2.0
// The Vulkan instance: loader opened at first use, validation layers on request, messages collected.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gpu/vulkan_api.h"

namespace photonloupe::gpu {

// Messages of the validation layers since they were last taken; any of them fails the stage that caused it.
struct ValidationLog {
    std::mutex mutex;
    std::vector<std::string> messages;
};

class Instance {
public:
    // The process's instance, made at first use. PHOTONLOUPE_VALIDATION=core|sync switches the layers on.
    static std::shared_ptr<Instance> acquire();
    ~Instance();

    VkInstance handle() const { return m_instance; }
    const std::string& validation_mode() const { return m_validation_mode; }
    std::vector<VkPhysicalDevice> find_physical_devices() const;
    // Throws DeviceError with the first message if the layers said anything.
    void require_silent_validation();

private:
    Instance();
    VkInstance m_instance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT m_messenger = VK_NULL_HANDLE;
    std::string m_validation_mode;
    ValidationLog m_log;
};

} // namespace photonloupe::gpu
