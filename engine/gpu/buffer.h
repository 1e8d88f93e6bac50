// SPDX-License-Identifier: Apache-2.0
// A block of device memory: uploaded, read back, and mapped in place where the device shares the host's memory.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace photonloupe::gpu {

class Device;

// Handle of memory that is freed with its last owner. A default-made buffer is empty and owns nothing.
class Buffer {
public:
    Buffer() = default;
    // `purpose` names the content in error messages. Throws MemoryError saying what would fit.
    Buffer(Device& device, std::uint64_t size_bytes, const char* purpose);
    Buffer(Buffer&& other) noexcept = default;
    Buffer& operator=(Buffer&& other) noexcept = default;

    // Another owner of the same memory: for content that nobody changes any more.
    Buffer share() const;

    std::uint64_t size_bytes() const;
    bool is_empty() const { return !m_impl; }
    // The host address of the content, or null where the device has memory of its own.
    const void* mapped() const;

    void upload(const void* source, std::uint64_t size_bytes, std::uint64_t offset = 0);
    void download(void* target, std::uint64_t size_bytes, std::uint64_t offset = 0) const;

    template <class T>
    std::vector<T> read(std::uint64_t count, std::uint64_t first = 0) const {
        std::vector<T> values(count);
        download(values.data(), count * sizeof(T), first * sizeof(T));
        return values;
    }

    struct Impl;
    Impl& impl() const { return *m_impl; }

private:
    std::shared_ptr<Impl> m_impl;
};

template <class T>
Buffer make_buffer(Device& device, std::span<const T> values, const char* purpose) {
    Buffer buffer(device, values.size_bytes(), purpose);
    buffer.upload(values.data(), values.size_bytes());
    return buffer;
}

template <class T>
Buffer make_buffer(Device& device, const std::vector<T>& values, const char* purpose) {
    return make_buffer(device, std::span<const T>(values), purpose);
}

} // namespace photonloupe::gpu
