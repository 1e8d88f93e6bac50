// SPDX-License-Identifier: Apache-2.0
// Runs the self-test dispatch and compares with the host's arithmetic.
#include "gpu/self_test.h"

#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>

#include <glm/vec4.hpp>

#include "gpu/commands.h"

namespace photonloupe::gpu {
namespace {

bool is_same(float a, float b) {
    return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0;
}

std::string compare(const std::vector<float>& numbers, const std::vector<glm::vec4>& results,
                    std::uint32_t subgroup_size) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const volatile float x = numbers[i];
        const volatile float sum = x + 1.0f;
        const volatile float difference = sum - x;
        const float lost = 1.0f - difference;
        const bool ok = is_same(results[i].x, x * x) && is_same(results[i].y, x - x) && is_same(results[i].z, lost);
        if (!ok)
            return "arithmetic differs from IEEE 754 at x = " + std::to_string(numbers[i]);
        if (results[i].w != static_cast<float>(subgroup_size))
            return "subgroups are not as wide as the device reports";
    }
    return {};
}

} // namespace

SelfTest run_self_test(Device& device) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<float> numbers{0.0f, -1.5f, 1e8f, 3e-20f, 1e30f, std::numeric_limits<float>::infinity()};
    const Buffer input = make_buffer(device, numbers, "self-test numbers");
    const Buffer output(device, numbers.size() * sizeof(glm::vec4), "self-test results");
    const auto count = static_cast<std::uint32_t>(numbers.size());
    dispatch(device, "self-test", {"gpu/self_test.comp", 0, {}, {}}, {{"numbers", input}, {"results", output}}, count,
             count);
    SelfTest test;
    test.message = compare(numbers, output.read<glm::vec4>(numbers.size()), device.limits().subgroup_size);
    test.ok = test.message.empty();
    test.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return test;
}

} // namespace photonloupe::gpu
