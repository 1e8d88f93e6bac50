// SPDX-License-Identifier: Apache-2.0
// What a Texture owns; shared by the files of engine/gpu and by the one of engine/studio that hands images to ImGui.
#pragma once

#include "gpu/texture.h"
#include "gpu/vulkan_api.h"

namespace photonloupe::gpu {

// As stored: sRGB values that nothing converts.
constexpr VkFormat TEXTURE_FORMAT = VK_FORMAT_R8G8B8A8_UNORM;

// Of a whole image's color.
inline VkImageMemoryBarrier describe_barrier(VkImage image, VkImageLayout from, VkImageLayout to, VkAccessFlags before,
                                             VkAccessFlags after) {
    return {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
            .srcAccessMask = before,
            .dstAccessMask = after,
            .oldLayout = from,
            .newLayout = to,
            .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .image = image,
            .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
}

struct Texture::Impl {
    Device* device = nullptr;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    std::uint64_t bytes = 0;
    // What was done to it last.
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkAccessFlags access = 0;
    VkPipelineStageFlags stage = VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT;

    Impl(Device& opened, std::uint32_t image_width, std::uint32_t image_height);
    ~Impl();
};

} // namespace photonloupe::gpu
