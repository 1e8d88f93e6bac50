// SPDX-License-Identifier: Apache-2.0
// Bytes go to the device and come back, in place or by way of staging, and too many are refused with what would fit.
#include "gpu/buffer.h"

#include <numeric>

#include <gtest/gtest.h>

#include "core/error.h"
#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

std::vector<std::uint32_t> make_numbers(std::size_t count) {
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0x9e3779b9u);
    return numbers;
}

// How a buffer's bytes reach the device: in place where it can, or forced through staging.
class BufferTransfer : public ::testing::TestWithParam<bool> {
protected:
    ScopedVariable m_staging{"PHOTONLOUPE_FORCE_STAGING", GetParam() ? "1" : "0"};
    gpu::Device m_device;
};

INSTANTIATE_TEST_SUITE_P(, BufferTransfer, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "staged" : "direct"; });

TEST_P(BufferTransfer, content_comes_back) {
    for (std::size_t count : {1, 3, 4, 1000, 1 << 20}) {
        const std::vector<std::uint32_t> numbers = make_numbers(count);
        EXPECT_EQ(gpu::make_buffer(m_device, numbers, "numbers").read<std::uint32_t>(count), numbers) << count;
    }
}

TEST_P(BufferTransfer, content_larger_than_one_staging_piece_comes_back) {
    const std::vector<std::uint32_t> numbers = make_numbers((70u << 20) / 4);
    EXPECT_TRUE(gpu::make_buffer(m_device, numbers, "numbers").read<std::uint32_t>(numbers.size()) == numbers);
}

TEST_P(BufferTransfer, part_is_replaced_and_read_at_its_offset) {
    gpu::Buffer buffer = gpu::make_buffer(m_device, make_numbers(100), "numbers");
    const std::vector<std::uint32_t> part{7, 8, 9};
    buffer.upload(part.data(), 12, 40);
    std::vector<std::uint32_t> expected = make_numbers(100);
    std::copy(part.begin(), part.end(), expected.begin() + 10);
    EXPECT_EQ(buffer.read<std::uint32_t>(5, 9), std::vector(expected.begin() + 9, expected.begin() + 14));
    EXPECT_EQ(buffer.read<std::uint32_t>(100), expected);
}

TEST_P(BufferTransfer, nothing_can_be_transferred) {
    gpu::Buffer buffer(m_device, 0, "nothing");
    EXPECT_NO_THROW(buffer.upload(nullptr, 0));
    EXPECT_TRUE(buffer.read<std::uint32_t>(0).empty());
}

TEST_P(BufferTransfer, transfer_past_the_end_is_a_mistake) {
    gpu::Buffer buffer(m_device, 64, "numbers");
    std::uint32_t numbers[32] = {};
    EXPECT_THROW(buffer.upload(numbers, 68), std::logic_error);
    EXPECT_THROW(buffer.upload(numbers, 4, 64), std::logic_error);
    EXPECT_THROW(buffer.download(numbers, 4, 62), std::logic_error);
    EXPECT_THROW(buffer.download(numbers, 8, UINT64_MAX - 3), std::logic_error);
}

TEST_P(BufferTransfer, memory_is_given_back) {
    const std::uint64_t before = m_device.allocated_bytes();
    {
        const gpu::Buffer buffer(m_device, 1 << 20, "numbers");
        EXPECT_EQ(m_device.allocated_bytes() - before, 1u << 20);
    }
    EXPECT_EQ(m_device.allocated_bytes(), before);
}

TEST(Buffer, staging_is_used_when_forced) {
    const ScopedVariable forced("PHOTONLOUPE_FORCE_STAGING", "1");
    gpu::Device device;
    EXPECT_FALSE(device.limits().host_visible);
    EXPECT_EQ(gpu::Buffer(device, 16, "numbers").mapped(), nullptr);
}

TEST(Buffer, moved_from_buffer_is_empty) {
    gpu::Buffer first(get_device(), 16, "numbers");
    const gpu::Buffer second = std::move(first);
    EXPECT_TRUE(first.is_empty());
    EXPECT_EQ(second.size_bytes(), 16u);
}

std::string find_refusal(std::uint64_t size_bytes) {
    try {
        gpu::Buffer buffer(get_device(), size_bytes, "photon positions");
    } catch (const MemoryError& error) {
        return error.what();
    }
    return "";
}

TEST(Buffer, refusal_says_what_is_needed_and_what_is_free) {
    const std::uint64_t limit = get_device().allocated_bytes() + (100u << 20);
    const ScopedVariable share("PHOTONLOUPE_MEMORY_LIMIT", std::to_string(limit));
    EXPECT_EQ(find_refusal(95u << 20), "photon positions: 95 MiB needed, 90 MiB free on " + get_device().info().name +
                                           "; ask for fewer photons or free memory");
}

TEST(Buffer, size_beyond_one_allocation_is_refused_with_the_limit) {
    const std::string message = find_refusal(get_device().limits().max_allocation_bytes + 1);
    EXPECT_NE(message.find("in one buffer, the device allows"), std::string::npos) << message;
}

TEST(Buffer, size_that_wraps_around_is_refused) {
    EXPECT_NE(find_refusal(UINT64_MAX), "");
}

} // namespace
} // namespace photonloupe::test
