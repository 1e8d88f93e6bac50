// SPDX-License-Identifier: Apache-2.0
// Command buffers: descriptors, barriers, push constants, timestamps, deadlines.
#include "gpu/commands.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>

#include "gpu/commands_impl.h"

namespace photonloupe::gpu {
namespace {

// A batch that takes this long is stuck: chunks aim at a twentieth of a second, the driver's first compilation of a
// kernel takes under a second.
constexpr double DEADLINE_SECONDS = 60.0;
constexpr double CHUNK_GROWTH_LIMIT = 8.0;
// Invocations a workgroup has at least where each item of a chunk is one invocation.
constexpr std::uint64_t SMALLEST_GROUP = 32;
constexpr std::uint32_t SETS_PER_POOL = 32;
constexpr std::uint32_t LARGEST_BINDING_COUNT = 32;
constexpr std::uint32_t PUSH_BYTES = 128;

double read_deadline_seconds() {
    const char* value = std::getenv("PHOTONLOUPE_DEADLINE"); // seconds; slow machines under a debugger need more
    const double seconds = value ? std::atof(value) : 0.0;
    return seconds > 0 ? seconds : DEADLINE_SECONDS;
}

} // namespace

Commands::Impl::~Impl() {
    if (!gpu().lost_because.empty())
        return; // the device may still be reading them
    const VolkDeviceTable& vk = gpu().table;
    for (VkDescriptorPool pool : pools)
        vk.vkDestroyDescriptorPool(gpu().device, pool, nullptr);
    vk.vkDestroyQueryPool(gpu().device, queries, nullptr);
    vk.vkDestroyFence(gpu().device, fence, nullptr);
    if (commands)
        vk.vkFreeCommandBuffers(gpu().device, gpu().command_pool, 1, &commands);
}

void Commands::Impl::begin() {
    gpu().require_alive();
    const VolkDeviceTable& vk = gpu().table;
    VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocation.commandPool = gpu().command_pool;
    allocation.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocation.commandBufferCount = 1;
    check(vk.vkAllocateCommandBuffers(gpu().device, &allocation, &commands), "vkAllocateCommandBuffers");
    VkFenceCreateInfo fence_info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vk.vkCreateFence(gpu().device, &fence_info, nullptr, &fence), "vkCreateFence");
    VkQueryPoolCreateInfo query_info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    query_info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    query_info.queryCount = 2;
    if (gpu().timestamp_nanoseconds > 0)
        check(vk.vkCreateQueryPool(gpu().device, &query_info, nullptr, &queries), "vkCreateQueryPool");
    VkCommandBufferBeginInfo begin_info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin_info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vk.vkBeginCommandBuffer(commands, &begin_info), "vkBeginCommandBuffer");
    if (queries) {
        vk.vkCmdResetQueryPool(commands, queries, 0, 2);
        vk.vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, queries, 0);
    }
    add_barrier();
}

void Commands::Impl::add_barrier() {
    VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                            VK_ACCESS_TRANSFER_WRITE_BIT;
    const VkPipelineStageFlags work = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    gpu().table.vkCmdPipelineBarrier(commands, work, work, 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

VkDescriptorSet Commands::Impl::allocate_set(VkDescriptorSetLayout layout) {
    const VolkDeviceTable& vk = gpu().table;
    if (sets_left == 0) {
        const VkDescriptorPoolSize sizes[] = {
            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, SETS_PER_POOL * LARGEST_BINDING_COUNT},
            {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, SETS_PER_POOL * LARGEST_BINDING_COUNT}};
        VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
        info.maxSets = SETS_PER_POOL;
        info.poolSizeCount = 2;
        info.pPoolSizes = sizes;
        VkDescriptorPool pool = VK_NULL_HANDLE;
        check(vk.vkCreateDescriptorPool(gpu().device, &info, nullptr, &pool), "vkCreateDescriptorPool");
        pools.push_back(pool);
        sets_left = SETS_PER_POOL;
    }
    --sets_left;
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    info.descriptorPool = pools.back();
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    check(vk.vkAllocateDescriptorSets(gpu().device, &info, &set), "vkAllocateDescriptorSets");
    return set;
}

VkDescriptorSet Commands::Impl::write_set(const Kernel& kernel, const std::vector<const Buffer*>& buffers,
                                          std::uint64_t by_address) {
    const VkDescriptorSet set = allocate_set(kernel.set_layout());
    std::vector<VkDescriptorBufferInfo> infos(buffers.size() + 1);
    std::vector<VkBufferView> views(buffers.size());
    std::vector<VkWriteDescriptorSet> writes;
    std::vector<VkDeviceAddress> addresses;
    for (std::uint32_t index = 0; index < buffers.size(); ++index) {
        Buffer::Impl& buffer = buffers[index]->impl();
        if (by_address >> index & 1) {
            addresses.push_back(buffer.address);
            continue;
        }
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, set, index, 0, 1};
        if (kernel.bindings()[index].kind == BindingKind::texel) {
            views[index] = buffer.view_texels();
            write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
            write.pTexelBufferView = &views[index];
        } else {
            infos[index] = {buffer.buffer, 0, buffer.capacity_bytes};
            write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            write.pBufferInfo = &infos[index];
        }
        writes.push_back(write);
    }
    if (by_address) {
        const Buffer& block = address_blocks.emplace_back(device, addresses.size() * 8, "buffer addresses");
        address_blocks.back().upload(addresses.data(), addresses.size() * 8);
        infos.back() = {block.impl().buffer, 0, VK_WHOLE_SIZE};
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,     nullptr, set,
                                   static_cast<std::uint32_t>(buffers.size()), 0,       1};
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo = &infos.back();
        writes.push_back(write);
    }
    gpu().table.vkUpdateDescriptorSets(gpu().device, static_cast<std::uint32_t>(writes.size()), writes.data(), 0,
                                       nullptr);
    return set;
}

void Commands::Impl::wait_for_fence() {
    const auto deadline = std::chrono::duration<double>(read_deadline_seconds());
    const auto nanoseconds = std::chrono::duration_cast<std::chrono::nanoseconds>(deadline).count();
    const VkResult result =
        gpu().table.vkWaitForFences(gpu().device, 1, &fence, VK_TRUE, static_cast<std::uint64_t>(nanoseconds));
    if (result == VK_SUCCESS)
        return;
    gpu().lost_because = stage + ": " +
                         (result == VK_TIMEOUT ? "no answer within " + std::to_string(deadline.count()) + " s"
                                               : describe_result(result));
    gpu().require_alive();
}

Commands::Commands(Device& device, std::string stage) : m_impl(std::make_unique<Impl>(device, std::move(stage))) {
    m_impl->begin();
}

Commands::~Commands() = default;

namespace {

std::vector<const Buffer*> match_bindings(const Kernel& kernel, std::span<const Binding> bindings) {
    std::vector<const Buffer*> buffers;
    for (const BindingDeclaration& declared : kernel.bindings()) {
        const auto found = std::find_if(bindings.begin(), bindings.end(),
                                        [&](const Binding& binding) { return binding.name == declared.name; });
        if (found == bindings.end() || found->buffer.is_empty())
            throw std::logic_error("kernel " + kernel.name() + " needs a buffer '" + declared.name + "'");
        buffers.push_back(&found->buffer);
    }
    return buffers;
}

std::uint64_t find_large(const Kernel& kernel, const std::vector<const Buffer*>& buffers, const DeviceLimits& limits) {
    std::uint64_t mask = 0;
    for (std::size_t index = 0; index < buffers.size(); ++index) {
        const std::uint64_t bytes = buffers[index]->size_bytes();
        const bool fits = kernel.bindings()[index].kind == BindingKind::texel ? bytes / 16 <= limits.max_texel_count
                                                                              : bytes <= limits.max_storage_range;
        mask |= static_cast<std::uint64_t>(!fits) << index;
    }
    return mask;
}

} // namespace

void Commands::record_dispatch(const KernelSource& source, std::span<const Binding> bindings, const void* push,
                               std::uint32_t push_bytes, std::uint64_t invocations) {
    if (push_bytes > PUSH_BYTES)
        throw std::logic_error("push constants of " + source.path + " exceed 128 bytes");
    Kernel& kernel = m_impl->device.find_kernel(source);
    const std::vector<const Buffer*> buffers = match_bindings(kernel, bindings);
    const std::uint64_t by_address = find_large(kernel, buffers, m_impl->device.limits());
    PipelineVariant& variant = kernel.find_variant(by_address);
    const VkDescriptorSet set = m_impl->write_set(kernel, buffers, by_address);
    const std::uint64_t groups = (invocations + kernel.workgroup_size() - 1) / kernel.workgroup_size();
    if (groups > m_impl->device.limits().max_group_count)
        throw std::logic_error("dispatch of " + source.path +
                               " exceeds the device's workgroup count; cut it in chunks");
    const VolkDeviceTable& vk = m_impl->gpu().table;
    const VkCommandBuffer commands = m_impl->commands;
    vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, variant.pipeline);
    vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.layout(), 0, 1, &set, 0, nullptr);
    std::uint8_t padded[PUSH_BYTES] = {};
    std::memcpy(padded, push, push_bytes);
    vk.vkCmdPushConstants(commands, kernel.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, PUSH_BYTES, padded);
    vk.vkCmdDispatch(commands, static_cast<std::uint32_t>(groups), 1, 1);
    m_impl->add_barrier();
    m_impl->dispatch_count += 1;
    if (!variant.is_warm)
        m_impl->cold.push_back(&variant);
}

void Commands::copy(const Buffer& source, std::uint64_t source_offset, const Buffer& target,
                    std::uint64_t target_offset, std::uint64_t size_bytes) {
    copy(source.impl(), source_offset, target.impl(), target_offset, size_bytes);
}

void Commands::copy(const Buffer::Impl& source, std::uint64_t source_offset, const Buffer::Impl& target,
                    std::uint64_t target_offset, std::uint64_t size_bytes) {
    if (size_bytes == 0)
        return;
    const VkBufferCopy region{source_offset, target_offset, size_bytes};
    m_impl->gpu().table.vkCmdCopyBuffer(m_impl->commands, source.buffer, target.buffer, 1, &region);
    m_impl->add_barrier();
}

void Commands::fill(const Buffer& target, std::uint32_t value) {
    m_impl->gpu().table.vkCmdFillBuffer(m_impl->commands, target.impl().buffer, 0, target.impl().capacity_bytes, value);
    m_impl->add_barrier();
}

double Commands::run() {
    Device::Impl& gpu = m_impl->gpu();
    const VolkDeviceTable& vk = gpu.table;
    if (m_impl->queries)
        vk.vkCmdWriteTimestamp(m_impl->commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, m_impl->queries, 1);
    VkMemoryBarrier to_host{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    to_host.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    to_host.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vk.vkCmdPipelineBarrier(m_impl->commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                            VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0, nullptr, 0, nullptr);
    check(vk.vkEndCommandBuffer(m_impl->commands), "vkEndCommandBuffer");
    const auto start = std::chrono::steady_clock::now();
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &m_impl->commands;
    check(vk.vkQueueSubmit(gpu.queue, 1, &submit, m_impl->fence), "vkQueueSubmit");
    m_impl->wait_for_fence();
    double milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    if (!gpu.is_rehearsal)
        gpu.instance->require_silent_validation();
    std::uint64_t ticks[2] = {};
    if (m_impl->queries && vk.vkGetQueryPoolResults(gpu.device, m_impl->queries, 0, 2, sizeof ticks, ticks, 8,
                                                    VK_QUERY_RESULT_64_BIT) == VK_SUCCESS)
        milliseconds = static_cast<double>(ticks[1] - ticks[0]) * gpu.timestamp_nanoseconds * 1e-6;
    for (PipelineVariant* variant : m_impl->cold)
        variant->is_warm = true;
    m_impl->device.record_timing(m_impl->stage, milliseconds, m_impl->dispatch_count);
    return m_impl->cold.empty() ? milliseconds : 0.0; // a first run is the driver's compiler, not the work
}

void fill(Device& device, const std::string& stage, const Buffer& target, std::uint32_t value) {
    Commands commands(device, stage);
    commands.fill(target, value);
    commands.run();
}

void copy(Device& device, const std::string& stage, const Buffer& source, const Buffer& target,
          std::uint64_t size_bytes) {
    Commands commands(device, stage);
    commands.copy(source, 0, target, 0, size_bytes);
    commands.run();
}

void run_in_chunks(Device& device, const std::string& stage, std::uint64_t total, std::uint64_t granule,
                   const Progress& progress, const std::function<void(Commands&, std::uint64_t, std::uint64_t)>& record,
                   std::uint64_t largest) {
    if (largest == 0)
        largest = std::uint64_t{device.limits().max_group_count} * SMALLEST_GROUP;
    std::uint64_t chunk = granule;
    for (std::uint64_t first = 0; first < total;) {
        progress.report(stage, static_cast<double>(first) / static_cast<double>(total));
        const std::uint64_t count = std::min({chunk, total - first, largest});
        Commands commands(device, stage);
        record(commands, first, count);
        const double milliseconds = commands.run();
        first += count;
        if (milliseconds <= 0)
            continue;
        const double growth = std::min(device.chunk_milliseconds() / milliseconds, CHUNK_GROWTH_LIMIT);
        const double granules = std::max(1.0, growth * static_cast<double>(count) / static_cast<double>(granule));
        chunk = granule * static_cast<std::uint64_t>(std::min(granules, 1e9));
    }
    progress.report(stage, 1.0);
}

} // namespace photonloupe::gpu
