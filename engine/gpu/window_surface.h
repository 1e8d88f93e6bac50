// SPDX-License-Identifier: Apache-2.0
// The pictures of a window: takes a texture to the screen.
#pragma once

#include <vector>

#include "gpu/commands.h"
#include "gpu/vulkan_api.h"

namespace photonloupe::gpu {

class WindowSurface {
public:
    // Owns the surface. Throws DeviceError where the device cannot show anything in it.
    WindowSurface(Device& device, VkSurfaceKHR surface);
    ~WindowSurface();
    WindowSurface(const WindowSurface&) = delete;
    WindowSurface& operator=(const WindowSurface&) = delete;

    // Shows the texture, scaled to the window. A window without any size is passed over.
    void present(Texture& picture);

private:
    void build(VkExtent2D wanted);
    void destroy();
    bool acquire(std::uint32_t& index);

    Device& m_device;
    VkSurfaceKHR m_surface = VK_NULL_HANDLE;
    VkSwapchainKHR m_swapchain = VK_NULL_HANDLE;
    VkExtent2D m_extent{};
    std::vector<VkImage> m_images;
    VkFence m_acquired = VK_NULL_HANDLE;
};

} // namespace photonloupe::gpu
