// SPDX-License-Identifier: Apache-2.0
// Work follows from the state in the order of the main flow, and is not done twice.
#include <gtest/gtest.h>

#include "studio/camera.h"
#include "studio/work.h"

namespace photonloupe::studio {
namespace {

class WorkPlan : public ::testing::Test {
protected:
    WorkPlan() { state.trace.scene = "/a.gltf"; }

    std::optional<Job> next() { return plan_work(state, find_pose(state.view.camera), wanted, holding, done); }
    // Does all there is to do; returns the kinds.
    std::vector<std::string> work() {
        std::vector<std::string> kinds;
        while (const std::optional<Job> job = next()) {
            kinds.push_back(job->kind);
            EXPECT_LT(kinds.size(), 20u);
            if (kinds.size() >= 20)
                break;
            done[job->kind] = job->key;
            holding.photons = holding.scene = true;
        }
        return kinds;
    }

    using Kinds = std::vector<std::string>;
    StudioState state;
    Wanted wanted;
    Holding holding;
    DoneWork done;
};

TEST_F(WorkPlan, empty_studio_has_nothing_to_do) {
    state.trace.scene.clear();
    wanted.image = true;
    EXPECT_FALSE(next());
}

TEST_F(WorkPlan, stages_come_in_the_order_of_the_flow) {
    state.script.ran = "a = 1;";
    state.relax.made = 1;
    state.image.reference = "/b.exr";
    holding.parameters = true;
    wanted = {true, true};
    EXPECT_EQ(work(), (Kinds{"trace", "script", "relax", "isotropy", "render", "reference"}));
    EXPECT_FALSE(next());
}

TEST_F(WorkPlan, nothing_follows_photons_that_failed) {
    state.script.ran = "a = 1;";
    done["trace"] = next()->key;
    EXPECT_FALSE(next());
}

TEST_F(WorkPlan, map_takes_the_place_of_tracing) {
    state.trace.map = "/m.zarr";
    const std::optional<Job> job = next();
    ASSERT_TRUE(job);
    EXPECT_EQ(job->kind, "map");
    EXPECT_EQ(job->state.trace.map, "/m.zarr");
}

TEST_F(WorkPlan, changed_seed_does_everything_again) {
    state.script.ran = "a = 1;";
    state.relax.made = 1;
    work();
    state.trace.seed = 2;
    EXPECT_EQ(work(), (Kinds{"trace", "script", "relax"}));
}

TEST_F(WorkPlan, changed_value_runs_script_and_relaxation_again) {
    state.script.ran = "a = 1;";
    state.relax.made = 1;
    work();
    state.script.values["a"] = 2;
    EXPECT_EQ(work(), (Kinds{"script", "relax"}));
}

TEST_F(WorkPlan, text_that_did_not_run_is_no_work) {
    work();
    state.script.text = "b = 2;";
    EXPECT_FALSE(next());
}

TEST_F(WorkPlan, another_step_goes_on_with_the_same_relaxation) {
    state.relax.made = 1;
    work();
    state.relax.made = 2;
    const std::optional<Job> job = next();
    ASSERT_TRUE(job);
    EXPECT_EQ(job->kind, "relax");
    EXPECT_EQ(job->state.relax.made, 2u);
}

TEST_F(WorkPlan, choices_that_were_not_used_are_no_work) {
    state.relax.made = 1;
    work();
    state.relax.choices.neighbors = 7;
    EXPECT_FALSE(next());
}

TEST_F(WorkPlan, camera_matters_to_the_render_alone) {
    wanted.image = true;
    work();
    state.view.camera.yaw += 0.1;
    EXPECT_EQ(work(), (Kinds{"render"}));
    wanted.image = false;
    state.view.camera.yaw += 0.1;
    EXPECT_FALSE(next());
}

TEST_F(WorkPlan, without_a_scene_nothing_is_rendered) {
    state.trace.scene.clear();
    state.trace.map = "/m.zarr";
    wanted.image = true;
    done["map"] = next()->key;
    holding.photons = true;
    done["script"] = next()->key;
    EXPECT_FALSE(next());
}

TEST_F(WorkPlan, new_photons_are_rendered_anew) {
    wanted.image = true;
    work();
    ++holding.photons_version;
    EXPECT_EQ(work(), (Kinds{"render"}));
}

TEST_F(WorkPlan, measured_constraint_is_a_relaxation_of_no_steps) {
    state.relax.is_measured = true;
    EXPECT_EQ(work(), (Kinds{"trace", "script", "relax"}));
}

} // namespace
} // namespace photonloupe::studio
