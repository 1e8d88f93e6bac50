// SPDX-License-Identifier: Apache-2.0
// The exchange between lanes, in shuffles, against loops on the host, at the width the device has.
#include <algorithm>
#include <random>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <gtest/gtest.h>

#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

constexpr std::size_t COUNT = 64 * 32; // whole workgroups
struct Rows {
    glm::vec4 folds, lanes;
};

// Some subgroups are wholly in, some wholly out, the others mixed; numbers are whole, so that sums are exact.
std::vector<glm::vec4> make_inputs(std::size_t width) {
    std::mt19937 random(7);
    std::vector<glm::vec4> inputs;
    for (std::size_t i = 0; i < COUNT; ++i) {
        const std::size_t kind = i / width % 4;
        inputs.emplace_back(random() % 1000, kind == 0 ? 0 : kind == 1 ? 1 : random() % 2, 0, 0);
    }
    return inputs;
}

TEST(Subgroup, tells_what_its_lanes_hold) {
    const std::size_t width = get_device().limits().subgroup_size;
    const std::vector<glm::vec4> inputs = make_inputs(width);
    const std::vector<Rows> found = run_probe<Rows>(get_device(), "probe_subgroup.comp", inputs);
    for (std::size_t first = 0; first < COUNT; first += width) {
        float least = 1e9f, greatest = -1, sum = 0, in_count = 0, first_in = -1;
        for (std::size_t lane = 0; lane < width; ++lane) {
            const glm::vec4& input = inputs[first + lane];
            least = std::min(least, input.x);
            greatest = std::max(greatest, input.x);
            sum += input.x;
            if (input.y > 0 && first_in < 0)
                first_in = static_cast<float>(lane);
            in_count += input.y;
        }
        float before = 0, in_before = 0;
        for (std::size_t lane = 0; lane < width; ++lane) {
            const Rows& rows = found[first + lane];
            const glm::vec4& input = inputs[first + lane];
            EXPECT_EQ(rows.folds, glm::vec4(least, greatest, sum, before));
            EXPECT_EQ(glm::vec2(rows.lanes.x, rows.lanes.y), glm::vec2(in_count, in_before));
            if (in_count > 0)
                EXPECT_EQ(rows.lanes.z, first_in);
            EXPECT_EQ(rows.lanes.w, float(in_count > 0) + 2.0f * float(in_count == float(width)) +
                                        4.0f * float(input.x == inputs[first + 1].x));
            before += input.x;
            in_before += input.y;
        }
    }
}

} // namespace
} // namespace photonloupe::test
