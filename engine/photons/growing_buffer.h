// SPDX-License-Identifier: Apache-2.0
// A device column that grows while photons arrive and is cut to about its size at the end.
#pragma once

#include "gpu/buffer.h"

namespace photonloupe {

class GrowingBuffer {
public:
    GrowingBuffer(gpu::Device& device, const char* purpose) : m_device(device), m_purpose(purpose) {}

    // Makes room for `size_bytes`, keeping the first `used_bytes`; grows by half at least, so that copies stay few.
    void reserve(std::uint64_t size_bytes, std::uint64_t used_bytes);
    const gpu::Buffer& buffer() const { return m_buffer; }
    // Hands over the first `size_bytes`, in a buffer that may be a little larger.
    gpu::Buffer finish(std::uint64_t size_bytes);

private:
    gpu::Device& m_device;
    const char* m_purpose;
    gpu::Buffer m_buffer;
};

} // namespace photonloupe
