// SPDX-License-Identifier: Apache-2.0
// Dear ImGui's own Vulkan objects: draws its lists into a texture and shows ours as images.
#pragma once

#include <memory>

#include "gpu/commands.h"
#include "gpu/texture.h"

struct GLFWwindow;
struct ImDrawData;

namespace photonloupe::gpu {
class WindowSurface;
}

namespace photonloupe::studio {

// Belongs to the current ImGui context, which must outlive it. Throws DeviceError on a device that cannot draw.
class ImGuiVulkan {
public:
    explicit ImGuiVulkan(gpu::Device& device);
    ~ImGuiVulkan();
    ImGuiVulkan(const ImGuiVulkan&) = delete;
    ImGuiVulkan& operator=(const ImGuiVulkan&) = delete;

    void begin_frame();
    void draw(gpu::Commands& commands, gpu::Texture& target, ImDrawData& data);

    // What ImGui calls a texture; valid until it is forgotten, or for as long as the texture lives.
    std::uint64_t add_texture(const gpu::Texture& texture);
    void forget_texture(std::uint64_t id);

private:
    gpu::Device& m_device;
};

// The pictures of a GLFW window.
std::unique_ptr<gpu::WindowSurface> open_surface(gpu::Device& device, GLFWwindow& window);

} // namespace photonloupe::studio
