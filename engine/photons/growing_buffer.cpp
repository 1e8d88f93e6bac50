// SPDX-License-Identifier: Apache-2.0
// Grows a device column by copying it into a larger one.
#include "photons/growing_buffer.h"

#include <algorithm>

#include "gpu/commands.h"

namespace photonloupe {
namespace {

// An eighth too large is kept: copying a whole column costs more than the memory is worth.
constexpr std::uint64_t WASTE_DIVISOR = 8;

gpu::Buffer copy_into_new(gpu::Device& device, const gpu::Buffer& old, std::uint64_t size_bytes,
                          std::uint64_t used_bytes, const char* purpose) {
    gpu::Buffer grown(device, size_bytes, purpose);
    if (used_bytes > 0)
        gpu::copy(device, "resize columns", old, grown, used_bytes);
    return grown;
}

} // namespace

void GrowingBuffer::reserve(std::uint64_t size_bytes, std::uint64_t used_bytes) {
    if (size_bytes <= m_buffer.size_bytes() && !m_buffer.is_empty())
        return;
    std::uint64_t grown = std::max(size_bytes, m_buffer.size_bytes() + m_buffer.size_bytes() / 2);
    grown = std::max(size_bytes, std::min(grown, m_device.limits().max_allocation_bytes));
    m_buffer = copy_into_new(m_device, m_buffer, grown, used_bytes, m_purpose);
}

gpu::Buffer GrowingBuffer::finish(std::uint64_t size_bytes) {
    if (m_buffer.is_empty() || m_buffer.size_bytes() - size_bytes > m_buffer.size_bytes() / WASTE_DIVISOR)
        m_buffer = copy_into_new(m_device, m_buffer, size_bytes, size_bytes, m_purpose);
    return std::move(m_buffer);
}

} // namespace photonloupe
