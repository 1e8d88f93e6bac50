// SPDX-License-Identifier: Apache-2.0
// Work of many items is cut so that no dispatch exceeds the device's workgroup count.
#include <gtest/gtest.h>

#include <glm/vec4.hpp>

#include "gpu/commands.h"
#include "support/shared_device.h"

namespace photonloupe {
namespace {

struct Push {
    std::uint32_t first;
    std::uint32_t count;
};

TEST(ChunksTest, items_beyond_one_dispatch_are_all_done) {
    gpu::Device& device = test::get_device();
    // More than 65,535 workgroups of 64, which many devices do not take at once; trivial work lets chunks grow that
    // far.
    constexpr std::uint64_t ITEM_COUNT = 5'000'000;
    const gpu::Buffer input(device, ITEM_COUNT * sizeof(glm::vec4), "input");
    const gpu::Buffer output(device, ITEM_COUNT * sizeof(glm::vec4), "output");
    gpu::run_in_chunks(device, "number", ITEM_COUNT, 1 << 16, {},
                       [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
                           const Push push{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)};
                           commands.dispatch({"photons/number_photons.comp", 64, {}, {}},
                                             {{"position_emitter", input}, {"tree_positions", output}}, push, count);
                       });
    for (const std::uint64_t item : {std::uint64_t{0}, ITEM_COUNT / 2, ITEM_COUNT - 1}) {
        std::uint32_t number = 0;
        output.download(&number, sizeof number, item * sizeof(glm::vec4) + 12);
        EXPECT_EQ(number, item);
    }
}

} // namespace
} // namespace photonloupe
