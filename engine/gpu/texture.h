// SPDX-License-Identifier: Apache-2.0
// An RGBA8 image on the device: what the interface shows, and what it is drawn into.
#pragma once

#include <cstdint>
#include <memory>

namespace photonloupe::gpu {

class Device;

// Move-only handle; freed with its last owner.
class Texture {
public:
    Texture(Device& device, std::uint32_t width, std::uint32_t height);
    ~Texture();
    Texture(Texture&& other) noexcept;
    Texture& operator=(Texture&& other) noexcept;

    std::uint32_t width() const;
    std::uint32_t height() const;

    struct Impl;
    Impl& impl() const { return *m_impl; }

private:
    std::unique_ptr<Impl> m_impl;
};

} // namespace photonloupe::gpu
