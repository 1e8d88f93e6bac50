// SPDX-License-Identifier: Apache-2.0
// Images that panels show: RGBA8 pixels of the host or of a buffer become textures of the interface, by name.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/texture.h"
#include "studio/imgui_vulkan.h"

namespace photonloupe::studio {

class PixelShow {
public:
    explicit PixelShow(gpu::Device& device) : m_device(device) {}
    ~PixelShow() { clear(); }

    void attach(ImGuiVulkan& drawing) { m_drawing = &drawing; }
    // Frees everything; to be called before the drawing goes.
    void clear();

    // Replaces the pixels of `name`: row 0 at the top. They are taken to the texture before the frame is drawn.
    void set(const std::string& name, std::uint32_t width, std::uint32_t height, std::vector<std::uint32_t> pixels);
    // The same from a buffer, which is copied on the device; it must live until the frame is drawn.
    void set(const std::string& name, std::uint32_t width, std::uint32_t height, const gpu::Buffer& pixels);
    // Records what `set` asked for.
    void upload(gpu::Commands& commands);

    // What ImGui calls it; 0: not set.
    std::uint64_t find(const std::string& name) const;

private:
    struct Entry {
        std::unique_ptr<gpu::Texture> texture;
        std::uint64_t id = 0;
        gpu::Buffer staged;                  // of host pixels
        const gpu::Buffer* source = nullptr; // waiting to be taken
    };
    Entry& prepare(const std::string& name, std::uint32_t width, std::uint32_t height);

    gpu::Device& m_device;
    ImGuiVulkan* m_drawing = nullptr;
    std::map<std::string, Entry> m_entries;
};

} // namespace photonloupe::studio
