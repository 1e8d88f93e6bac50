// SPDX-License-Identifier: Apache-2.0
// The swap chain: made anew when the window changes, filled by scaled copies, waited for on the host.
#include "gpu/window_surface.h"

#include <algorithm>

#include "core/error.h"
#include "gpu/commands_impl.h"

namespace photonloupe::gpu {
namespace {

// How long the window system may take to hand out a picture.
constexpr std::uint64_t ACQUIRE_NANOSECONDS = 2'000'000'000;
constexpr std::uint32_t PICTURE_COUNT = 3;

VkSurfaceFormatKHR choose_format(VkPhysicalDevice physical, VkSurfaceKHR surface) {
    std::uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, nullptr),
          "vkGetPhysicalDeviceSurfaceFormats");
    std::vector<VkSurfaceFormatKHR> formats(count);
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, formats.data()),
          "vkGetPhysicalDeviceSurfaceFormats");
    for (const VkSurfaceFormatKHR& format : formats)
        if (format.format == VK_FORMAT_B8G8R8A8_UNORM || format.format == VK_FORMAT_R8G8B8A8_UNORM)
            return format;
    throw DeviceError("the window takes no 8-bit pictures; use `studio --screenshot`");
}

} // namespace

WindowSurface::WindowSurface(Device& device, VkSurfaceKHR surface) : m_device(device), m_surface(surface) {
    Device::Impl& gpu = device.impl();
    VkBool32 supported = VK_FALSE;
    if (device.limits().can_present)
        check(vkGetPhysicalDeviceSurfaceSupportKHR(gpu.physical, gpu.queue_family, surface, &supported),
              "vkGetPhysicalDeviceSurfaceSupport");
    if (!supported)
        throw DeviceError("device '" + device.info().name +
                          "' cannot show pictures in a window; choose another with --device, or use --screenshot");
    VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(gpu.table.vkCreateFence(gpu.device, &info, nullptr, &m_acquired), "vkCreateFence");
}

WindowSurface::~WindowSurface() {
    Device::Impl& gpu = m_device.impl();
    if (!gpu.lost_because.empty())
        return;
    destroy();
    gpu.table.vkDestroyFence(gpu.device, m_acquired, nullptr);
    vkDestroySurfaceKHR(gpu.instance->handle(), m_surface, nullptr);
}

void WindowSurface::destroy() {
    Device::Impl& gpu = m_device.impl();
    std::lock_guard lock(gpu.mutex); // each batch is waited for: nothing runs now
    gpu.table.vkDestroySwapchainKHR(gpu.device, m_swapchain, nullptr);
    m_swapchain = VK_NULL_HANDLE;
}

void WindowSurface::build(VkExtent2D wanted) {
    destroy();
    Device::Impl& gpu = m_device.impl();
    VkSurfaceCapabilitiesKHR can;
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu.physical, m_surface, &can), "vkGetPhysicalDeviceSurface");
    m_extent = can.currentExtent.width != UINT32_MAX ? can.currentExtent : wanted;
    if (m_extent.width == 0 || m_extent.height == 0)
        return;
    const VkSurfaceFormatKHR format = choose_format(gpu.physical, m_surface);
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = m_surface;
    info.minImageCount = std::max(can.minImageCount, PICTURE_COUNT);
    if (can.maxImageCount > 0)
        info.minImageCount = std::min(info.minImageCount, can.maxImageCount);
    info.imageFormat = format.format;
    info.imageColorSpace = format.colorSpace;
    info.imageExtent = m_extent;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    check(gpu.table.vkCreateSwapchainKHR(gpu.device, &info, nullptr, &m_swapchain), "vkCreateSwapchainKHR");
    std::uint32_t count = 0;
    check(gpu.table.vkGetSwapchainImagesKHR(gpu.device, m_swapchain, &count, nullptr), "vkGetSwapchainImagesKHR");
    m_images.resize(count);
    check(gpu.table.vkGetSwapchainImagesKHR(gpu.device, m_swapchain, &count, m_images.data()),
          "vkGetSwapchainImagesKHR");
}

// False: the window changed, and the swap chain with it.
bool WindowSurface::acquire(std::uint32_t& index) {
    Device::Impl& gpu = m_device.impl();
    const VkResult result = gpu.table.vkAcquireNextImageKHR(gpu.device, m_swapchain, ACQUIRE_NANOSECONDS,
                                                            VK_NULL_HANDLE, m_acquired, &index);
    // A hidden window may be given no picture: the next frame asks again.
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_TIMEOUT || result == VK_NOT_READY)
        return false;
    check(result, "vkAcquireNextImageKHR");
    check(gpu.table.vkWaitForFences(gpu.device, 1, &m_acquired, VK_TRUE, ACQUIRE_NANOSECONDS), "vkWaitForFences");
    check(gpu.table.vkResetFences(gpu.device, 1, &m_acquired), "vkResetFences");
    return true;
}

void WindowSurface::present(Texture& picture) {
    const VkExtent2D wanted{picture.width(), picture.height()};
    std::uint32_t index = 0;
    if (m_swapchain == VK_NULL_HANDLE || !acquire(index)) {
        build(wanted);
        if (m_swapchain == VK_NULL_HANDLE || !acquire(index))
            return;
    }
    Device::Impl& gpu = m_device.impl();
    std::lock_guard lock(gpu.mutex);
    {
        Commands commands(m_device, "present");
        Commands::Impl& impl = commands.impl();
        impl.use_texture(picture.impl(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_ACCESS_TRANSFER_READ_BIT,
                         VK_PIPELINE_STAGE_TRANSFER_BIT);
        const VkImageMemoryBarrier before =
            describe_barrier(m_images[index], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 0,
                             VK_ACCESS_TRANSFER_WRITE_BIT);
        gpu.table.vkCmdPipelineBarrier(impl.commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
                                       0, nullptr, 0, nullptr, 1, &before);
        VkImageBlit region{};
        region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.dstSubresource = region.srcSubresource;
        region.srcOffsets[1] = {static_cast<int>(picture.width()), static_cast<int>(picture.height()), 1};
        region.dstOffsets[1] = {static_cast<int>(m_extent.width), static_cast<int>(m_extent.height), 1};
        gpu.table.vkCmdBlitImage(impl.commands, picture.impl().image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                 m_images[index], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_NEAREST);
        const VkImageMemoryBarrier after =
            describe_barrier(m_images[index], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                             VK_ACCESS_TRANSFER_WRITE_BIT, 0);
        gpu.table.vkCmdPipelineBarrier(impl.commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                       VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, 0, 0, nullptr, 0, nullptr, 1, &after);
        commands.run();
    }
    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.swapchainCount = 1;
    info.pSwapchains = &m_swapchain;
    info.pImageIndices = &index;
    const VkResult result = gpu.table.vkQueuePresentKHR(gpu.queue, &info);
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR)
        destroy();
    else
        check(result, "vkQueuePresentKHR");
    gpu.instance->require_silent_validation();
}

} // namespace photonloupe::gpu
