// SPDX-License-Identifier: Apache-2.0
// A compiled kernel and its variants (one for each set of buffers that must go by address).
#pragma once

#include <unordered_map>

#include "gpu/device.h"
#include "gpu/kernel_source.h"
#include "gpu/vulkan_api.h"

namespace photonloupe::gpu {

struct PipelineVariant {
    VkPipeline pipeline = VK_NULL_HANDLE;
    bool is_warm = false; // the driver compiles at the first dispatch; that one is not timed
};

class Kernel {
public:
    Kernel(Device::Impl& device, const KernelSource& source);
    ~Kernel();
    Kernel(const Kernel&) = delete;
    Kernel& operator=(const Kernel&) = delete;

    const std::string& name() const { return m_source.path; }
    const std::vector<BindingDeclaration>& bindings() const { return m_expanded.bindings; }
    std::uint32_t workgroup_size() const { return m_source.workgroup_size; }
    VkPipelineLayout layout() const { return m_layout; }
    VkDescriptorSetLayout set_layout() const { return m_set_layout; }
    PipelineVariant& find_variant(std::uint64_t by_address);

private:
    Device::Impl& m_device;
    KernelSource m_source;
    ExpandedSource m_expanded;
    VkDescriptorSetLayout m_set_layout = VK_NULL_HANDLE;
    VkPipelineLayout m_layout = VK_NULL_HANDLE;
    std::unordered_map<std::uint64_t, PipelineVariant> m_variants;
};

} // namespace photonloupe::gpu
