// SPDX-License-Identifier: Apache-2.0
// Allocates, maps, uploads and reads back device memory: one allocation a buffer.
#include "gpu/buffer.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/error.h"
#include "gpu/buffer_impl.h"
#include "gpu/commands.h"

namespace photonloupe::gpu {
namespace {

// Staging copies move in pieces of this size, so that a download needs no second copy of a large map.
constexpr std::uint64_t STAGING_BYTES = 64ull << 20;
constexpr std::uint64_t SMALLEST_BUFFER_BYTES = 16;
constexpr std::uint64_t TEXEL_BYTES = 16;      // RGBA32F
constexpr std::uint64_t TEXEL_PAD_BYTES = 256; // see pad_texels()

std::string describe_mebibytes(std::uint64_t bytes) {
    return std::to_string((bytes + (1u << 20) - 1) >> 20) + " MiB";
}

// Mesa 22.3's software device takes a buffer's size for an image's: a kernel that reads texels is compiled anew, and
// for each such buffer by itself, where the size is a power of two or its second byte is 0. So no buffer there has such
// a size: every kernel has one machine code.
std::uint64_t pad_texels(std::uint64_t bytes) {
    while (std::has_single_bit(bytes) || (bytes / TEXEL_PAD_BYTES) % 256 == 0)
        bytes += TEXEL_PAD_BYTES;
    return bytes;
}

} // namespace

Buffer::Impl::Impl(Device& opened, std::uint64_t size, std::uint32_t memory_type, const char* purpose)
    : device(&opened), size_bytes(size), capacity_bytes(std::max(size, SMALLEST_BUFFER_BYTES)) {
    Device::Impl& owner = opened.impl();
    owner.require_alive();
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    capacity_bytes = (capacity_bytes + TEXEL_BYTES - 1) / TEXEL_BYTES * TEXEL_BYTES;
    const bool is_validated = !owner.instance->validation_mode().empty(); // the layers must see where buffers end
    const bool pads = owner.info.type == "software" && !is_validated;
    texel_bytes = pads ? pad_texels(capacity_bytes) : capacity_bytes;
    if (texel_bytes / TEXEL_BYTES > owner.limits.max_texel_count)
        texel_bytes = capacity_bytes;
    info.size = texel_bytes;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                 VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    const VolkDeviceTable& vk = owner.table;
    check(vk.vkCreateBuffer(owner.device, &info, nullptr, &buffer), purpose);
    VkMemoryRequirements needs;
    vk.vkGetBufferMemoryRequirements(owner.device, buffer, &needs);
    VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags};
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = memory_type;
    if (vk.vkAllocateMemory(owner.device, &allocation, nullptr, &memory) != VK_SUCCESS) {
        vk.vkDestroyBuffer(owner.device, buffer, nullptr);
        throw MemoryError(std::string(purpose) + ": the device refused " + describe_mebibytes(size) +
                          "; ask for fewer photons or free memory");
    }
    check(vk.vkBindBufferMemory(owner.device, buffer, memory, 0), "vkBindBufferMemory");
    owner.allocated_bytes += capacity_bytes;
    if (owner.memory.memoryTypes[memory_type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT)
        check(vk.vkMapMemory(owner.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
    if (mapped) // texels past the end read as 0, as they do where there is no padding
        std::memset(static_cast<char*>(mapped) + capacity_bytes, 0, texel_bytes - capacity_bytes);
    VkBufferDeviceAddressInfo query{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    query.buffer = buffer;
    address = vk.vkGetBufferDeviceAddress(owner.device, &query);
}

Buffer::Impl::~Impl() {
    Device::Impl& owner = device->impl();
    if (!owner.lost_because.empty())
        return; // still in use by work that never came back
    owner.table.vkDestroyBufferView(owner.device, texels, nullptr);
    owner.table.vkDestroyBuffer(owner.device, buffer, nullptr);
    owner.table.vkFreeMemory(owner.device, memory, nullptr);
    owner.allocated_bytes -= capacity_bytes;
}

VkBufferView Buffer::Impl::view_texels() {
    if (texels)
        return texels;
    VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    info.buffer = buffer;
    info.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    info.range = texel_bytes;
    check(device->impl().table.vkCreateBufferView(device->impl().device, &info, nullptr, &texels),
          "vkCreateBufferView");
    return texels;
}

Buffer::Buffer(Device& device, std::uint64_t size_bytes, const char* purpose) {
    const DeviceLimits& limits = device.limits();
    if (size_bytes > limits.max_allocation_bytes)
        throw MemoryError(std::string(purpose) + ": " + describe_mebibytes(size_bytes) +
                          " in one buffer, the device allows " + describe_mebibytes(limits.max_allocation_bytes) +
                          "; ask for fewer photons");
    if (const std::uint64_t available = device.available_bytes(); size_bytes > available)
        throw MemoryError(std::string(purpose) + ": " + describe_mebibytes(size_bytes) + " needed, " +
                          describe_mebibytes(available) + " free on " + device.info().name +
                          "; ask for fewer photons or free memory");
    m_impl = std::make_shared<Impl>(device, size_bytes, device.impl().memory_type_main, purpose);
}

Buffer Buffer::share() const {
    Buffer other;
    other.m_impl = m_impl;
    return other;
}

std::uint64_t Buffer::size_bytes() const {
    return m_impl ? m_impl->size_bytes : 0;
}

const void* Buffer::mapped() const {
    return m_impl && m_impl->device->limits().host_visible ? m_impl->mapped : nullptr;
}

void Buffer::upload(const void* source, std::uint64_t size_bytes, std::uint64_t offset) {
    if (size_bytes == 0)
        return;
    if (!m_impl->holds(offset, size_bytes))
        throw std::logic_error("upload past the end of a buffer");
    if (void* target = const_cast<void*>(mapped())) {
        std::memcpy(static_cast<char*>(target) + offset, source, size_bytes);
        return;
    }
    Device& device = *m_impl->device;
    Impl staging(device, std::min(size_bytes, STAGING_BYTES), device.impl().memory_type_staging, "staging");
    for (std::uint64_t done = 0; done < size_bytes; done += STAGING_BYTES) {
        const std::uint64_t piece = std::min(STAGING_BYTES, size_bytes - done);
        std::memcpy(staging.mapped, static_cast<const char*>(source) + done, piece);
        Commands commands(device, "upload");
        commands.copy(staging, 0, *m_impl, offset + done, piece);
        commands.run();
    }
}

void Buffer::download(void* target, std::uint64_t size_bytes, std::uint64_t offset) const {
    if (size_bytes == 0)
        return;
    if (!m_impl->holds(offset, size_bytes))
        throw std::logic_error("download past the end of a buffer");
    if (const void* source = mapped()) {
        std::memcpy(target, static_cast<const char*>(source) + offset, size_bytes);
        return;
    }
    Device& device = *m_impl->device;
    Impl staging(device, std::min(size_bytes, STAGING_BYTES), device.impl().memory_type_staging, "staging");
    for (std::uint64_t done = 0; done < size_bytes; done += STAGING_BYTES) {
        const std::uint64_t piece = std::min(STAGING_BYTES, size_bytes - done);
        Commands commands(device, "download");
        commands.copy(*m_impl, offset + done, staging, 0, piece);
        commands.run();
        std::memcpy(static_cast<char*>(target) + done, staging.mapped, piece);
    }
}

} // namespace photonloupe::gpu
