// SPDX-License-Identifier: Apache-2.0
// Work of many items is cut so that no dispatch exceeds the device's workgroup count.
#include <gtest/gtest.h>

#include <glm/vec4.hpp>

#include "gpu/commands.h"
#include "shared/photons.h"
#include "support/shared_device.h"

namespace photonloupe {
namespace {

TEST(ChunksTest, items_beyond_one_dispatch_are_all_done) {
    gpu::Device& device = test::get_device();
    // More than 65,535 workgroups of 64, which many devices do not take at once; trivial work lets chunks grow that
    // far.
    constexpr std::uint64_t ITEM_COUNT = 5'000'000;
    const gpu::Buffer input(device, ITEM_COUNT * sizeof(glm::vec4), "input");
    const gpu::Buffer reach = gpu::make_buffer(device, std::vector<float>{7.0f}, "reach");
    const gpu::Buffer output(device, ITEM_COUNT * sizeof(float), "output");
    gpu::Commands clear(device, "clear");
    clear.fill(input, 0); // all photons have id 0
    clear.run();
    gpu::run_in_chunks(device, "order", ITEM_COUNT, 1 << 16, {},
                       [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
                           const shared::ReachSettings push{static_cast<std::uint32_t>(first),
                                                            static_cast<std::uint32_t>(count), 1, 1.0f};
                           commands.dispatch(
                               {"photons/order_reaches.comp", 64, {}, {}},
                               {{"tree_positions", input}, {"reaches_by_id", reach}, {"tree_reaches", output}}, push,
                               count);
                       });
    for (const std::uint64_t item : {std::uint64_t{0}, ITEM_COUNT / 2, ITEM_COUNT - 1})
        EXPECT_EQ(output.read<float>(1, item)[0], 7.0f);
}

} // namespace
} // namespace photonloupe
