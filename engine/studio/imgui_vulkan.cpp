// SPDX-License-Identifier: Apache-2.0
// Hands images and command buffers to ImGui's Vulkan backend: the one file outside engine/gpu that knows Vulkan.
#include "studio/imgui_vulkan.h"

#include <mutex>

#include "gpu/device_impl.h"
#include "gpu/texture_impl.h"
#include "gpu/window_surface.h"

#include <imgui.h>
#include <imgui_impl_vulkan.h>

#include <GLFW/glfw3.h>

#include "core/error.h"

namespace photonloupe::studio {
namespace {

// Textures the interface may show at a time, beside its own.
constexpr std::uint32_t TEXTURE_COUNT = 64;
constexpr std::uint32_t IMAGES_IN_FLIGHT = 2; // the least the backend takes; frames are waited for

// The backend asks for functions of both kinds by name.
PFN_vkVoidFunction find_function(const char* name, void* user) {
    return vkGetInstanceProcAddr(static_cast<const gpu::Device::Impl*>(user)->instance->handle(), name);
}

void check_result(VkResult result) {
    gpu::check(result, "interface");
}

} // namespace

ImGuiVulkan::ImGuiVulkan(gpu::Device& device) : m_device(device) {
    if (!device.limits().can_draw)
        throw DeviceError("device '" + device.info().name +
                          "' cannot draw the interface (it lacks graphics or VK_KHR_dynamic_rendering); choose another "
                          "with --device");
    gpu::Device::Impl& gpu = device.impl();
    std::lock_guard lock(gpu.mutex);
    ImGui_ImplVulkan_LoadFunctions(VK_API_VERSION_1_2, find_function, &gpu);
    ImGui_ImplVulkan_InitInfo info{};
    info.ApiVersion = VK_API_VERSION_1_2;
    info.Instance = gpu.instance->handle();
    info.PhysicalDevice = gpu.physical;
    info.Device = gpu.device;
    info.QueueFamily = gpu.queue_family;
    info.Queue = gpu.queue;
    info.DescriptorPoolSize = TEXTURE_COUNT;
    info.MinImageCount = IMAGES_IN_FLIGHT;
    info.ImageCount = IMAGES_IN_FLIGHT;
    info.PipelineCache = gpu.pipeline_cache;
    info.UseDynamicRendering = true;
    info.PipelineInfoMain.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.PipelineInfoMain.PipelineRenderingCreateInfo = {VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO_KHR};
    info.PipelineInfoMain.PipelineRenderingCreateInfo.colorAttachmentCount = 1;
    info.PipelineInfoMain.PipelineRenderingCreateInfo.pColorAttachmentFormats = &gpu::TEXTURE_FORMAT;
    info.CheckVkResultFn = check_result;
    ImGui_ImplVulkan_Init(&info);
}

ImGuiVulkan::~ImGuiVulkan() {
    gpu::Device::Impl& gpu = m_device.impl();
    if (!gpu.lost_because.empty())
        return;                      // work that never came back may still use them
    std::lock_guard lock(gpu.mutex); // each batch is waited for: nothing runs now
    ImGui_ImplVulkan_Shutdown();
}

void ImGuiVulkan::begin_frame() {
    ImGui_ImplVulkan_NewFrame();
}

void ImGuiVulkan::draw(gpu::Commands& commands, gpu::Texture& target, ImDrawData& data) {
    commands.draw(target, [&](void* command_buffer) {
        ImGui_ImplVulkan_RenderDrawData(&data, static_cast<VkCommandBuffer>(command_buffer));
    });
}

std::uint64_t ImGuiVulkan::add_texture(const gpu::Texture& texture) {
    std::lock_guard lock(m_device.impl().mutex);
    return reinterpret_cast<std::uint64_t>(
        ImGui_ImplVulkan_AddTexture(texture.impl().view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
}

void ImGuiVulkan::forget_texture(std::uint64_t id) {
    if (!m_device.impl().lost_because.empty())
        return;
    std::lock_guard lock(m_device.impl().mutex);
    ImGui_ImplVulkan_RemoveTexture(reinterpret_cast<VkDescriptorSet>(id));
}

std::unique_ptr<gpu::WindowSurface> open_surface(gpu::Device& device, GLFWwindow& window) {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    const auto instance = device.impl().instance->handle();
    if (glfwCreateWindowSurface(instance, &window, nullptr, &surface) != VK_SUCCESS)
        throw DeviceError("Vulkan cannot draw into a window on this screen; use `studio --screenshot`");
    return std::make_unique<gpu::WindowSurface>(device, surface);
}

} // namespace photonloupe::studio
