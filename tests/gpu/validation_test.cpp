// SPDX-License-Identifier: Apache-2.0
// The validation layers are really listened to: a mistake made on purpose fails the stage that made it.
#include <cstdlib>

#include <gtest/gtest.h>

#include "core/error.h"
#include "gpu/commands.h"

namespace photonloupe {
namespace {

// In a process of its own: the instance of the other tests has no layers.
[[noreturn]] void copy_past_the_end() {
    setenv("PHOTONLOUPE_VALIDATION", "core", 1);
    try {
        gpu::Device device;
        const gpu::Buffer source(device, 64, "source");
        const gpu::Buffer target(device, 64, "target");
        gpu::Commands commands(device, "mistake");
        commands.copy(source, 32, target, 0, 64);
        commands.run();
    } catch (const DeviceError& error) {
        std::fprintf(stderr, "%s\n", error.what());
        std::_Exit(1);
    }
    std::_Exit(0);
}

TEST(ValidationDeathTest, a_copy_past_the_end_fails_its_stage) {
    EXPECT_EXIT(copy_past_the_end(), ::testing::ExitedWithCode(1), "Vulkan validation: .*vkCmdCopyBuffer");
}

} // namespace
} // namespace photonloupe
