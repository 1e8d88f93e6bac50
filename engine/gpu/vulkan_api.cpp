// SPDX-License-Identifier: Apache-2.0
// Turns Vulkan result codes into our exceptions.
#define VOLK_IMPLEMENTATION
#include "gpu/vulkan_api.h"

#include "core/error.h"

namespace photonloupe::gpu {

std::string describe_result(VkResult result) {
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "out of device memory";
    case VK_ERROR_DEVICE_LOST:
        return "the device was lost";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "initialization failed";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "incompatible driver";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "layer not present";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "extension not present";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "feature not present";
    case VK_TIMEOUT:
        return "timeout";
    default:
        return "VkResult " + std::to_string(static_cast<int>(result));
    }
}

void check(VkResult result, const char* call) {
    if (result >= VK_SUCCESS)
        return;
    std::string message = std::string(call) + ": " + describe_result(result);
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY)
        throw MemoryError(message + "; close other programs or ask for fewer photons");
    if (result == VK_ERROR_DEVICE_LOST)
        throw DeviceError(message + "; open the device again, and try a smaller job if it is lost again");
    throw DeviceError(message);
}

} // namespace photonloupe::gpu
