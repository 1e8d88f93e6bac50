// SPDX-License-Identifier: Apache-2.0
// Makes and frees images, and records what moves pixels into them and out of them.
#include "gpu/texture.h"

#include "core/error.h"
#include "gpu/commands_impl.h"

namespace photonloupe::gpu {
namespace {

constexpr VkImageSubresourceRange WHOLE{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
constexpr VkImageSubresourceLayers LAYERS{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

} // namespace

Texture::Impl::Impl(Device& opened, std::uint32_t image_width, std::uint32_t image_height)
    : device(&opened), width(image_width), height(image_height) {
    Device::Impl& owner = opened.impl();
    owner.require_alive();
    const VolkDeviceTable& vk = owner.table;
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = TEXTURE_FORMAT;
    info.extent = {width, height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                 VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    check(vk.vkCreateImage(owner.device, &info, nullptr, &image), "vkCreateImage");
    VkMemoryRequirements needs;
    vk.vkGetImageMemoryRequirements(owner.device, image, &needs);
    VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = owner.memory_type_main;
    if (vk.vkAllocateMemory(owner.device, &allocation, nullptr, &memory) != VK_SUCCESS) {
        vk.vkDestroyImage(owner.device, image, nullptr);
        throw MemoryError("the device refused an image of " + std::to_string(width) + " × " + std::to_string(height) +
                          "; make the window smaller or free memory");
    }
    check(vk.vkBindImageMemory(owner.device, image, memory, 0), "vkBindImageMemory");
    bytes = needs.size;
    owner.allocated_bytes += bytes;
    VkImageViewCreateInfo view_info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view_info.image = image;
    view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view_info.format = TEXTURE_FORMAT;
    view_info.subresourceRange = WHOLE;
    check(vk.vkCreateImageView(owner.device, &view_info, nullptr, &view), "vkCreateImageView");
}

Texture::Impl::~Impl() {
    Device::Impl& owner = device->impl();
    if (!owner.lost_because.empty())
        return; // still in use by work that never came back
    owner.table.vkDestroyImageView(owner.device, view, nullptr);
    owner.table.vkDestroyImage(owner.device, image, nullptr);
    owner.table.vkFreeMemory(owner.device, memory, nullptr);
    owner.allocated_bytes -= bytes;
}

Texture::Texture(Device& device, std::uint32_t width, std::uint32_t height)
    : m_impl(std::make_unique<Impl>(device, width, height)) {}

Texture::~Texture() = default;
Texture::Texture(Texture&& other) noexcept = default;
Texture& Texture::operator=(Texture&& other) noexcept = default;

std::uint32_t Texture::width() const {
    return m_impl->width;
}
std::uint32_t Texture::height() const {
    return m_impl->height;
}

void Commands::Impl::use_texture(Texture::Impl& texture, VkImageLayout layout, VkAccessFlags access,
                                 VkPipelineStageFlags next) {
    const VkImageMemoryBarrier barrier =
        describe_barrier(texture.image, texture.layout, layout, texture.access, access);
    gpu().table.vkCmdPipelineBarrier(commands, texture.stage, next, 0, 0, nullptr, 0, nullptr, 1, &barrier);
    texture.layout = layout;
    texture.access = access;
    texture.stage = next;
}

void Commands::copy(const Buffer& pixels, Texture& target) {
    Texture::Impl& texture = target.impl();
    m_impl->use_texture(texture, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_PIPELINE_STAGE_TRANSFER_BIT);
    const VkBufferImageCopy region{0, 0, 0, LAYERS, {0, 0, 0}, {texture.width, texture.height, 1}};
    m_impl->gpu().table.vkCmdCopyBufferToImage(m_impl->commands, pixels.impl().buffer, texture.image, texture.layout, 1,
                                               &region);
    m_impl->use_texture(texture, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_ACCESS_SHADER_READ_BIT,
                        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT);
}

void Commands::copy(Texture& source, const Buffer& pixels) {
    Texture::Impl& texture = source.impl();
    m_impl->use_texture(texture, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_ACCESS_TRANSFER_READ_BIT,
                        VK_PIPELINE_STAGE_TRANSFER_BIT);
    const VkBufferImageCopy region{0, 0, 0, LAYERS, {0, 0, 0}, {texture.width, texture.height, 1}};
    m_impl->gpu().table.vkCmdCopyImageToBuffer(m_impl->commands, texture.image, texture.layout, pixels.impl().buffer, 1,
                                               &region);
    m_impl->add_barrier();
}

void Commands::draw(Texture& target, const std::function<void(void*)>& record) {
    Texture::Impl& texture = target.impl();
    m_impl->use_texture(texture, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                        VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT,
                        VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT);
    VkRenderingAttachmentInfoKHR attachment{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO_KHR};
    attachment.imageView = texture.view;
    attachment.imageLayout = texture.layout;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.clearValue.color = {{0, 0, 0, 1}};
    VkRenderingInfoKHR info{VK_STRUCTURE_TYPE_RENDERING_INFO_KHR};
    info.renderArea.extent = {texture.width, texture.height};
    info.layerCount = 1;
    info.colorAttachmentCount = 1;
    info.pColorAttachments = &attachment;
    const VolkDeviceTable& vk = m_impl->gpu().table;
    vk.vkCmdBeginRenderingKHR(m_impl->commands, &info);
    record(m_impl->commands);
    vk.vkCmdEndRenderingKHR(m_impl->commands);
}

} // namespace photonloupe::gpu
