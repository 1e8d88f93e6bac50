// SPDX-License-Identifier: Apache-2.0
// What a batch of commands owns; shared by the files of engine/gpu and by no one else.
#pragma once

#include <deque>
#include <mutex>

#include "gpu/buffer_impl.h"
#include "gpu/commands.h"
#include "gpu/device_impl.h"
#include "gpu/texture_impl.h"

namespace photonloupe::gpu {

struct Commands::Impl {
    Device& device;
    std::string stage;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    VkQueryPool queries = VK_NULL_HANDLE;
    std::vector<VkDescriptorPool> pools;
    std::uint32_t sets_left = 0;
    std::deque<Buffer> address_blocks;
    std::vector<PipelineVariant*> cold;
    std::uint64_t dispatch_count = 0;
    std::unique_lock<TurnMutex> lock;

    Impl(Device& owner, std::string name) : device(owner), stage(std::move(name)), lock(owner.impl().mutex) {}
    ~Impl();
    Device::Impl& gpu() { return device.impl(); }
    void begin();
    void add_barrier();
    // Takes a texture from what was done to it last to what comes next.
    void use_texture(Texture::Impl& texture, VkImageLayout layout, VkAccessFlags access, VkPipelineStageFlags stage);
    VkDescriptorSet allocate_set(VkDescriptorSetLayout layout);
    VkDescriptorSet write_set(const Kernel& kernel, const std::vector<const Buffer*>& buffers,
                              std::uint64_t by_address);
    void wait_for_fence();
};

} // namespace photonloupe::gpu
