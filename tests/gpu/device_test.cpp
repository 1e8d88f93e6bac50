// SPDX-License-Identifier: Apache-2.0
// Choosing a device, exact arithmetic on it, and what happens when it does not come back.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

#include <glm/vec4.hpp>

#include <gtest/gtest.h>

#include "core/error.h"
#include "gpu/self_test.h"
#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

std::string find_refusal(const std::string& selector) {
    try {
        gpu::Device device(selector);
    } catch (const DeviceError& error) {
        return error.what();
    }
    return "";
}

TEST(Device, auto_takes_a_usable_device_and_says_why) {
    EXPECT_TRUE(get_device().info().usable);
    EXPECT_EQ(get_device().chosen_because(), "first usable device of type " + get_device().info().type);
}

TEST(Device, index_takes_that_device) {
    const gpu::Device device(std::to_string(get_device().info().index));
    EXPECT_EQ(device.info().name, get_device().info().name);
}

TEST(Device, part_of_a_name_takes_that_device) {
    const std::string name = get_device().info().name;
    const gpu::Device device(name.substr(0, name.size() / 2));
    EXPECT_EQ(device.info().name, name);
}

TEST(Device, index_beyond_the_last_is_refused_with_the_list) {
    const std::string message = find_refusal("999");
    EXPECT_NE(message.find("no device matches '999'"), std::string::npos) << message;
    EXPECT_NE(message.find(get_device().info().name), std::string::npos) << message;
}

TEST(Device, negative_index_is_refused) {
    EXPECT_NE(find_refusal("-1").find("'-1'"), std::string::npos);
}

TEST(Device, unknown_name_is_refused_with_the_list) {
    const std::string message = find_refusal("Voodoo 2");
    EXPECT_NE(message.find("no device matches 'Voodoo 2'"), std::string::npos) << message;
    EXPECT_NE(message.find("0: "), std::string::npos) << message;
}

TEST(Device, self_test_finds_no_fault) {
    EXPECT_EQ(gpu::run_self_test(get_device()).message, "");
}

constexpr int TERMS = 1000;

std::vector<glm::vec4> list_sums() {
    std::vector<glm::vec4> inputs;
    for (float x : {0.0f, 1.0f, -1.5f, 0.1f, 3e-8f, 1e-20f, 16777217.0f, 1e30f})
        for (float y : {0.0f, 1.0f, -0.3f, 1e7f, 1e-30f, 3.4e38f})
            inputs.emplace_back(x, y, 0, 0);
    const float inf = std::numeric_limits<float>::infinity();
    inputs.emplace_back(inf, 1, 0, 0);
    inputs.emplace_back(std::nanf(""), 1, 0, 0);
    return inputs;
}

glm::vec4 sum_on_host(float x_value, float y_value) {
    const volatile float x = x_value, y = y_value;
    const volatile float both = x + y;
    volatile float sum = y, lost = 0;
    for (int i = 0; i < TERMS; ++i) {
        const volatile float next = x - lost, larger = sum + next, grown = larger - sum;
        lost = grown - next;
        sum = larger;
    }
    return {x - x, both - y, both - x, sum};
}

bool is_same(float a, float b) {
    return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(Device, sums_round_as_on_the_host) {
    const std::vector<glm::vec4> inputs = list_sums();
    const auto outputs =
        run_probe<glm::vec4>(get_device(), "probe_exact.comp", inputs, {"TERMS " + std::to_string(TERMS)});
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::vec4 expected = sum_on_host(inputs[i].x, inputs[i].y);
        for (int part = 0; part < 4; ++part)
            EXPECT_TRUE(is_same(outputs[i][part], expected[part]))
                << inputs[i].x << ", " << inputs[i].y << " part " << part << ": " << outputs[i][part] << " for "
                << expected[part];
    }
}

TEST(Device, timings_add_up_by_stage_until_they_are_taken) {
    get_device().take_timings();
    run_probe<glm::vec4>(get_device(), "probe_exact.comp", list_sums(), {"TERMS 1"});
    run_probe<glm::vec4>(get_device(), "probe_exact.comp", list_sums(), {"TERMS 1"});
    EXPECT_EQ(get_device().take_timings()["probe"].dispatch_count, 2u);
    EXPECT_TRUE(get_device().take_timings().empty());
}

// Runs in a process of its own: the device is still busy when it ends.
[[noreturn]] void lose_device() {
    setenv("PHOTONLOUPE_DEADLINE", "0.2", 1);
    gpu::Device device;
    try {
        const gpu::Buffer output(device, 16, "probe outputs");
        gpu::Commands commands(device, "probe");
        commands.dispatch({"probe_loop.comp", 64, {}, {}}, {{"outputs", output}}, 1u << 31, 1u << 21);
        commands.run();
    } catch (const DeviceError& error) {
        std::fprintf(stderr, "first: %s\n", error.what());
    }
    try {
        gpu::Buffer buffer(device, 16, "anything");
    } catch (const DeviceError& error) {
        std::fprintf(stderr, "second: %s\n", error.what());
    }
    std::_Exit(0);
}

TEST(DeviceDeathTest, missed_deadline_is_reported_with_its_stage) {
    EXPECT_EXIT(lose_device(), ::testing::ExitedWithCode(0), "first: .*probe: no answer within 0\\.2");
}

TEST(DeviceDeathTest, lost_device_refuses_further_use_and_says_why) {
    EXPECT_EXIT(lose_device(), ::testing::ExitedWithCode(0), "second: this device can no longer be used \\(probe");
}

} // namespace
} // namespace photonloupe::test
