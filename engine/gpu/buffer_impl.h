// SPDX-License-Identifier: Apache-2.0
// What a Buffer owns; shared by the files of engine/gpu and by no one else.
#pragma once

#include "gpu/buffer.h"
#include "gpu/device_impl.h"

namespace photonloupe::gpu {

struct Buffer::Impl {
    Device* device = nullptr;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkBufferView texels = VK_NULL_HANDLE; // made when a kernel first reads it as a texel buffer
    VkDeviceAddress address = 0;
    std::uint64_t size_bytes = 0;
    std::uint64_t capacity_bytes = 0; // the size in whole texels
    std::uint64_t texel_bytes = 0;    // the same with padding: what a view of texels covers
    void* mapped = nullptr;

    Impl(Device& opened, std::uint64_t size, std::uint32_t memory_type, const char* purpose);
    ~Impl();
    VkBufferView view_texels();
    bool holds(std::uint64_t offset, std::uint64_t bytes) const {
        return bytes <= capacity_bytes && offset <= capacity_bytes - bytes;
    }
};

} // namespace photonloupe::gpu
