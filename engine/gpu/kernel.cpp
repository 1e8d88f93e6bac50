// SPDX-License-Identifier: Apache-2.0
// Builds pipelines: expands the source, compiles it, fixes the specialisation constants.
#include "gpu/kernel.h"

#include "core/error.h"
#include "gpu/compile_glsl.h"
#include "gpu/device_impl.h"

namespace photonloupe::gpu {
namespace {

// Vulkan guarantees 128 bytes of push constants everywhere; settings structs stay below.
constexpr std::uint32_t PUSH_CONSTANT_BYTES = 128;
// Of the specialisation constant in shaders/shared/subgroup.glsl.
constexpr std::uint32_t SUBGROUP_SIZE_ID = 63;

VkDescriptorType find_descriptor_type(BindingKind kind) {
    return kind == BindingKind::texel ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

VkDescriptorSetLayout create_set_layout(const Device::Impl& device, const std::vector<BindingDeclaration>& bindings) {
    std::vector<VkDescriptorSetLayoutBinding> slots;
    for (std::uint32_t index = 0; index <= bindings.size(); ++index) { // one more: the block of addresses
        const bool is_block = index == bindings.size();
        const VkDescriptorType type =
            is_block ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : find_descriptor_type(bindings[index].kind);
        slots.push_back({index, type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    info.bindingCount = static_cast<std::uint32_t>(slots.size());
    info.pBindings = slots.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    check(device.table.vkCreateDescriptorSetLayout(device.device, &info, nullptr, &layout),
          "vkCreateDescriptorSetLayout");
    return layout;
}

VkPipelineLayout create_pipeline_layout(const Device::Impl& device, VkDescriptorSetLayout set_layout) {
    const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, PUSH_CONSTANT_BYTES};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = 1;
    info.pSetLayouts = &set_layout;
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &push;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check(device.table.vkCreatePipelineLayout(device.device, &info, nullptr, &layout), "vkCreatePipelineLayout");
    return layout;
}

VkPipeline create_pipeline(const Device::Impl& device, const KernelSource& source, VkPipelineLayout layout,
                           const std::vector<std::uint32_t>& words) {
    VkShaderModuleCreateInfo module_info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    module_info.codeSize = words.size() * 4;
    module_info.pCode = words.data();
    VkShaderModule module = VK_NULL_HANDLE;
    check(device.table.vkCreateShaderModule(device.device, &module_info, nullptr, &module), "vkCreateShaderModule");
    std::vector<std::uint32_t> constants{source.workgroup_size};
    constants.insert(constants.end(), source.constants.begin(), source.constants.end());
    std::vector<VkSpecializationMapEntry> entries;
    for (std::uint32_t id = 0; id < constants.size(); ++id)
        entries.push_back({id, id * 4, 4});
    entries.push_back({SUBGROUP_SIZE_ID, static_cast<std::uint32_t>(constants.size()) * 4, 4});
    constants.push_back(device.limits.subgroup_size);
    const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                              constants.size() * 4, constants.data()};
    VkPipelineShaderStageRequiredSubgroupSizeCreateInfo subgroup{
        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO};
    subgroup.requiredSubgroupSize = device.limits.subgroup_size;
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  device.fixes_subgroup_size ? &subgroup : nullptr,
                  0,
                  VK_SHADER_STAGE_COMPUTE_BIT,
                  module,
                  "main",
                  &specialization};
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result =
        device.table.vkCreateComputePipelines(device.device, device.pipeline_cache, 1, &info, nullptr, &pipeline);
    device.table.vkDestroyShaderModule(device.device, module, nullptr);
    check(result, source.path.c_str());
    return pipeline;
}

} // namespace

Kernel::Kernel(Device::Impl& device, const KernelSource& source)
    : m_device(device), m_source(source), m_expanded(expand_source(source)) {
    if (m_source.workgroup_size == 0)
        m_source.workgroup_size = device.limits.subgroup_size;
    m_set_layout = create_set_layout(device, m_expanded.bindings);
    m_layout = create_pipeline_layout(device, m_set_layout);
}

Kernel::~Kernel() {
    for (const auto& [mask, variant] : m_variants)
        m_device.table.vkDestroyPipeline(m_device.device, variant.pipeline, nullptr);
    m_device.table.vkDestroyPipelineLayout(m_device.device, m_layout, nullptr);
    m_device.table.vkDestroyDescriptorSetLayout(m_device.device, m_set_layout, nullptr);
}

PipelineVariant& Kernel::find_variant(std::uint64_t by_address) {
    const auto found = m_variants.find(by_address);
    if (found != m_variants.end())
        return found->second;
    const std::string text = declare_bindings(m_expanded, m_source.defines, by_address);
    const VkPipeline pipeline = create_pipeline(m_device, m_source, m_layout, compile_glsl(text, m_source.path));
    return m_variants.emplace(by_address, PipelineVariant{pipeline, false}).first->second;
}

Kernel& Device::find_kernel(const KernelSource& source) {
    const std::string key = make_key(source);
    const auto find = [&]() -> Kernel* {
        const auto found = m_impl->kernels.find(key);
        return found == m_impl->kernels.end() ? nullptr : found->second.get();
    };
    {
        std::lock_guard lock(m_impl->kernels_mutex);
        if (Kernel* kernel = find())
            return *kernel;
    }
    m_impl->ahead->claim(source);
    std::lock_guard lock(m_impl->kernels_mutex);
    if (Kernel* kernel = find()) // handed over by the thread that was waited for
        return *kernel;
    return *m_impl->kernels.emplace(key, std::make_unique<Kernel>(*m_impl, source)).first->second;
}

} // namespace photonloupe::gpu
