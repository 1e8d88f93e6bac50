// SPDX-License-Identifier: Apache-2.0
// Keeps one texture a name, made anew when its size changes.
#include "studio/show_pixels.h"

#include <stdexcept>
#include <utility>

namespace photonloupe::studio {

void PixelShow::clear() {
    for (auto& [name, entry] : m_entries)
        if (entry.id && m_drawing)
            m_drawing->forget_texture(entry.id);
    m_entries.clear();
}

PixelShow::Entry& PixelShow::prepare(const std::string& name, std::uint32_t width, std::uint32_t height) {
    Entry& entry = m_entries[name];
    if (entry.texture && entry.texture->width() == width && entry.texture->height() == height)
        return entry;
    if (entry.id)
        m_drawing->forget_texture(std::exchange(entry.id, 0));
    entry.source = nullptr;
    entry.texture = std::make_unique<gpu::Texture>(m_device, width, height);
    entry.id = m_drawing->add_texture(*entry.texture);
    return entry;
}

void PixelShow::set(const std::string& name, std::uint32_t width, std::uint32_t height,
                    std::vector<std::uint32_t> pixels) {
    if (pixels.size() != std::size_t{width} * height)
        throw std::logic_error("pixels of '" + name + "' do not fit its size");
    Entry& entry = prepare(name, width, height);
    if (entry.staged.size_bytes() != pixels.size() * sizeof pixels[0])
        entry.staged = gpu::Buffer(m_device, pixels.size() * sizeof pixels[0], "picture");
    entry.staged.upload(pixels.data(), pixels.size() * sizeof pixels[0]);
    entry.source = &entry.staged;
}

void PixelShow::set(const std::string& name, std::uint32_t width, std::uint32_t height, const gpu::Buffer& pixels) {
    prepare(name, width, height).source = &pixels;
}

void PixelShow::upload(gpu::Commands& commands) {
    for (auto& [name, entry] : m_entries)
        if (entry.source)
            commands.copy(*std::exchange(entry.source, nullptr), *entry.texture);
}

std::uint64_t PixelShow::find(const std::string& name) const {
    const auto found = m_entries.find(name);
    return found == m_entries.end() ? 0 : found->second.id;
}

} // namespace photonloupe::studio
