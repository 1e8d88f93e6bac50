// SPDX-License-Identifier: Apache-2.0
// Where buffers lie and how kernels reach them never changes a result: in place, staged, or by address.
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

#include "photons/nearest_query.h"
#include "pipeline.h"
#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

// What every stage gives for one scene, as plain values.
struct Results {
    std::vector<std::uint32_t> positions, small_ids, large_ids, own_ids, irradiance;
    std::vector<float> image;
};

std::vector<glm::vec4> draw_points(std::size_t count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-1, 1);
    std::vector<glm::vec4> points;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = place(random), z = place(random);
        points.emplace_back(x, 0, z, 0);
    }
    return points;
}

Results run_stages(gpu::Device& device) {
    constexpr std::uint64_t QUERIES = 200;
    const std::vector<glm::vec4> points = draw_points(QUERIES), normals(QUERIES, {0, 1, 0, 0});
    const std::vector<std::uint32_t> ids{0, 1, 77, 2999};
    const Scene scene = load_scene(PHOTONLOUPE_SOURCE_DIR "/scenes/slab/slab.gltf");
    Workbench workbench(device);
    const auto photons = workbench.trace_photons(scene, {.count = 3000}, {});
    Results results;
    results.positions = photons->map.position_emitter.read<std::uint32_t>(4 * photons->map.count);
    results.small_ids =
        find_neighbors(device, *photons, {.places = points, .k = 10}, {}).ids.read<std::uint32_t>(10 * QUERIES);
    results.large_ids =
        find_neighbors(device, *photons, {.places = points, .k = 400}, {}).ids.read<std::uint32_t>(400 * QUERIES);
    results.own_ids =
        find_neighbors(device, *photons, {.ids = ids, .k = 10}, {}).ids.read<std::uint32_t>(10 * ids.size());
    results.irradiance =
        workbench.estimate_irradiance(*photons, points, normals, {.k = 20}, {}).read<std::uint32_t>(4 * QUERIES);
    results.image =
        workbench.render(scene, photons.get(), {}, {.width = 16, .height = 16, .samples = 1, .estimate = {.k = 20}}, {})
            .rgb;
    return results;
}

const Results& get_usual_results() {
    static const Results results = run_stages(get_device());
    return results;
}

void expect_usual_results(gpu::Device& device) {
    const Results results = run_stages(device);
    EXPECT_TRUE(results.positions == get_usual_results().positions) << "photons differ";
    EXPECT_TRUE(results.small_ids == get_usual_results().small_ids) << "10 neighbors differ";
    EXPECT_TRUE(results.large_ids == get_usual_results().large_ids) << "400 neighbors differ";
    EXPECT_TRUE(results.own_ids == get_usual_results().own_ids) << "photons' own neighbors differ";
    EXPECT_TRUE(results.irradiance == get_usual_results().irradiance) << "irradiance differs";
    EXPECT_TRUE(results.image == get_usual_results().image) << "images differ";
}

TEST(Placement, stages_give_the_same_bits_on_a_second_device) {
    gpu::Device device;
    expect_usual_results(device);
}

TEST(Placement, stages_give_the_same_bits_staged) {
    const ScopedVariable forced("PHOTONLOUPE_FORCE_STAGING", "1");
    gpu::Device device;
    expect_usual_results(device);
}

// In a process of its own: where a descriptor would bound a read past a buffer's end, an address does not.
TEST(PlacementDeathTest, stages_give_the_same_bits_by_address) {
    const auto run_by_address = [] {
        const ScopedVariable range("PHOTONLOUPE_STORAGE_RANGE", "64");
        gpu::Device device;
        expect_usual_results(device);
        std::_Exit(::testing::Test::HasFailure() ? 1 : 0);
    };
    EXPECT_EXIT(run_by_address(), ::testing::ExitedWithCode(0), "");
}

} // namespace
} // namespace photonloupe::test
