// SPDX-License-Identifier: Apache-2.0
// A stage that is asked the same again dispatches nothing; one of whose inputs another is asked runs.
#include <gtest/gtest.h>

#include "pipeline.h"
#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

constexpr const char* SCRIPT = "declarePhotonParameter(3, 0, 1, \"east\"); shift = 0; expose shift range 0, 1;"
                               "for (i = 0; i < getNumPhotons(); i++) setPhotonParameter(i, 3, shift + "
                               "getPhotonPosition(i, X));";

class Memory : public testing::Test {
protected:
    std::shared_ptr<Photons> trace(std::uint64_t count = 3000) {
        return m_bench.trace_photons(m_scene, {.count = count}, {});
    }
    void run_script(Photons& photons, double shift, bool keeps = false) {
        const auto script = script::compile_script({"east", SCRIPT});
        m_bench.run_script(photons, *script, {.values = {{"shift", shift}}}, keeps, {});
    }
    // Dispatches of some work.
    template <class Work>
    std::uint64_t count(const Work& work) {
        get_device().take_timings();
        work();
        std::uint64_t dispatches = 0;
        for (const auto& [stage, timing] : get_device().take_timings())
            dispatches += timing.dispatch_count;
        return dispatches;
    }

    Scene m_scene = load_scene(PHOTONLOUPE_SOURCE_DIR "/scenes/slab/slab.gltf");
    Workbench m_bench{get_device()};
};

TEST_F(Memory, traces_once) {
    const auto photons = trace();
    std::shared_ptr<Photons> again;
    EXPECT_EQ(count([&] { again = trace(); }), 0u);
    EXPECT_NE(again, photons);
    EXPECT_EQ(again->map.position_emitter.read<std::uint32_t>(4 * photons->map.count),
              photons->map.position_emitter.read<std::uint32_t>(4 * photons->map.count));
    EXPECT_GT(count([&] { trace(4000); }), 0u);
}

TEST_F(Memory, traces_again_what_nobody_holds) {
    trace();
    EXPECT_GT(count([&] { trace(); }), 0u);
}

TEST_F(Memory, aims_its_lights_once) {
    const auto emitters = m_bench.find_emitters(m_scene, Store::caustic);
    EXPECT_EQ(m_bench.find_emitters(m_scene, Store::caustic), emitters);
    EXPECT_NE(m_bench.find_emitters(m_scene, Store::all), emitters); // not aimed
    EXPECT_GT(emitters->cells.size(), 1u);
}

TEST_F(Memory, hands_out_photons_as_they_were_traced) {
    const auto photons = trace();
    run_script(*photons, 0.5);
    EXPECT_FALSE(trace()->map.parameters);
}

TEST_F(Memory, runs_a_script_once) {
    const auto photons = trace();
    run_script(*photons, 0.5);
    const std::vector<float> values = *photons->map.parameters->given;
    const auto other = trace();
    EXPECT_EQ(count([&] { run_script(*photons, 0.5); }), 0u);
    EXPECT_EQ(count([&] { run_script(*other, 0.5); }), 0u);
    EXPECT_EQ(*other->map.parameters->given, values);
    EXPECT_GT(count([&] { run_script(*photons, 0.25); }), 0u);
    EXPECT_GT(count([&] { run_script(*photons, 0.25, true); }), 0u);
}

TEST_F(Memory, relaxes_once) {
    const auto photons = trace();
    RelaxSettings settings{.steps = 2};
    RelaxedRun run = m_bench.relax_photons(*photons, &m_scene, settings, {});
    EXPECT_EQ(run.steps.size(), 2u);
    EXPECT_EQ(count([&] { m_bench.relax_photons(*photons, &m_scene, settings, {}); }), 0u);
    EXPECT_GT(count([&] { m_bench.relax_photons(*photons, nullptr, settings, {}); }), 0u);
    settings.limit = 0.25f;
    EXPECT_GT(count([&] { m_bench.relax_photons(*photons, &m_scene, settings, {}); }), 0u);
}

TEST_F(Memory, estimates_once) {
    const auto photons = trace();
    std::vector<glm::vec4> points(10), normals(10, {0, 1, 0, 0});
    const auto estimate = [&] { m_bench.estimate_irradiance(*photons, points, normals, {.k = 20}, {}); };
    estimate();
    EXPECT_EQ(count(estimate), 0u);
    points[3].x = 0.25f;
    EXPECT_GT(count(estimate), 0u);
}

TEST_F(Memory, renders_once) {
    const auto photons = trace();
    RenderSettings settings{.width = 16, .height = 16, .samples = 1};
    CameraChoice camera;
    const auto render = [&] { m_bench.render(m_scene, photons.get(), camera, settings, {}); };
    run_script(*photons, 0.5);
    render();
    EXPECT_EQ(count(render), 0u);
    settings.samples = 2;
    EXPECT_GT(count(render), 0u);
    camera.placed.emplace();
    EXPECT_GT(count(render), 0u);
    run_script(*photons, 0.25);
    EXPECT_GT(count(render), 0u);
}

TEST_F(Memory, forgets_when_told) {
    const auto photons = trace();
    m_bench.forget();
    EXPECT_GT(count([&] { trace(); }), 0u);
}

TEST_F(Memory, keeps_trees_for_those_that_share_columns) {
    const auto photons = trace();
    const std::shared_ptr<const KdTree> tree = find_tree(get_device(), *photons);
    EXPECT_EQ(find_tree(get_device(), *share_photons(*photons)), tree);
}

TEST(Memo, tells_keys_apart) {
    const auto thing = std::make_shared<int>(), other = std::make_shared<int>();
    EXPECT_EQ(MemoKey(1, "a").add(thing), MemoKey(1, "a").add(thing));
    EXPECT_FALSE(MemoKey(1, "a").add(thing) == MemoKey(1, "a").add(other));
    EXPECT_FALSE(MemoKey(1, "a") == MemoKey(1, "a").add(thing));
    EXPECT_FALSE(MemoKey(0.1f) == MemoKey(0.1));
}

} // namespace
} // namespace photonloupe::test
