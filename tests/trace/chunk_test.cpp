// SPDX-License-Identifier: Apache-2.0
// The order of a chunk's lanes against sorting.
#include "trace/chunk.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "shared/random.h"

namespace photonloupe::test {
namespace {

// Bits of two fractions in turn, the first one's before the second's, one by one.
std::uint64_t interleave(std::uint32_t u, std::uint32_t v) {
    std::uint64_t key = 0;
    for (int bit = 31; bit >= 0; --bit)
        key = key << 2 | (u >> bit & 1u) << 1 | (v >> bit & 1u);
    return key;
}

TEST(chunk, lanes_follow_the_net_along_a_curve_that_fills_the_square) {
    for (const std::uint32_t size : {4096u, 8192u, 1u << 20}) {
        std::vector<std::uint32_t> sorted(size);
        std::iota(sorted.begin(), sorted.end(), 0u);
        std::vector<std::uint64_t> keys(size);
        for (std::uint32_t i = 0; i < size; ++i)
            keys[i] = interleave(shared::sobol_bits(i, 0), shared::sobol_bits(i, 1));
        std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
        EXPECT_EQ(order_lanes(size, Emission::sobol), sorted) << size;
    }
}

TEST(chunk, random_emission_has_no_order) {
    const std::vector<std::uint32_t> order = order_lanes(4096, Emission::random);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

} // namespace
} // namespace photonloupe::test
