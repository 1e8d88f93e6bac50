// SPDX-License-Identifier: Apache-2.0
// The loupe and the columns as the engine's own users call them.
#include "inspect/loupe.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "inspect/columns/columns.h"
#include "inspect/inspect_maps.h"

namespace photonloupe::test {
namespace {

using namespace inspect;

constexpr std::uint32_t COUNT = 500;

// One parameter, the photon's x.
Photons make_layers() {
    const std::vector<glm::vec3> points = draw_points(COUNT, 1);
    Photons photons = make_floor_photons(points);
    std::vector<float> values;
    for (const glm::vec3& point : points)
        values.push_back(point.x);
    photons.map.parameters = make_parameters(get_device(), values, {{"east", -2, 2, 0}});
    return photons;
}

std::string find_error(Photons& photons, const LoupeQuery& query) {
    try {
        look_through_loupe(get_device(), photons, query);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

TEST(Loupe, ranges_lock_the_layer_around_a_photon_too) {
    Photons photons = make_layers();
    LoupeQuery query;
    query.photon = 7;
    query.k = COUNT;
    query.space = SearchSpace::constrained;
    query.low = {-0.25f};
    query.high = {0.5f};
    const LoupeView view = look_through_loupe(get_device(), photons, query);
    const std::vector<glm::vec3> points = draw_points(COUNT, 1);
    std::vector<std::uint32_t> expected, found = view.ids;
    for (std::uint32_t id = 0; id < COUNT; ++id)
        if (points[id].x >= -0.25f && points[id].x <= 0.5f)
            expected.push_back(id);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
    EXPECT_TRUE(std::is_sorted(view.distances.begin(), view.distances.end()));
    EXPECT_EQ(view.center, 7u);
}

TEST(Loupe, keeps_parameters_in_tree_order_until_they_change) {
    Photons photons = make_layers();
    LoupeQuery query;
    query.space = SearchSpace::constrained;
    look_through_loupe(get_device(), photons, query);
    const std::shared_ptr<const ParameterTree> kept = find_layered_tree(get_device(), photons);
    look_through_loupe(get_device(), photons, query);
    EXPECT_EQ(find_layered_tree(get_device(), photons), kept);
    set_parameters(get_device(), photons, std::vector<float>(COUNT), {{"east", 0, 1, 0}});
    look_through_loupe(get_device(), photons, query);
    EXPECT_NE(find_layered_tree(get_device(), photons), kept);
}

TEST(Loupe, refuses_what_does_not_fit_the_map) {
    Photons photons = make_layers(), plain = make_floor_photons(draw_points(10, 2));
    LoupeQuery missing, pinned, ranges, parameters, nowhere, none;
    missing.photon = COUNT;
    pinned.pinned = COUNT;
    ranges.space = parameters.space = SearchSpace::constrained;
    ranges.low = ranges.high = {0, 0};
    nowhere.point[1] = NAN;
    none.k = 0;
    EXPECT_EQ(find_error(photons, missing), "loupe: photon 500 is not in the map; it has 500 photons");
    EXPECT_EQ(find_error(photons, pinned), "loupe: photon 500 is not in the map; it has 500 photons");
    EXPECT_EQ(find_error(photons, ranges), "loupe: ranges of 2 parameters were given; the map has 1");
    EXPECT_EQ(find_error(photons, nowhere), "loupe: the point is not finite; give world coordinates in metres");
    EXPECT_NE(find_error(photons, none), "");
    EXPECT_NE(find_error(plain, parameters), "");
    EXPECT_EQ(find_error(photons, parameters), "");
    EXPECT_THROW(read_path_lines(photons, std::vector<std::uint32_t>{0}), Error);
}

TEST(Loupe, positions_far_out_keep_their_digits) {
    std::vector<glm::vec3> points = draw_points(COUNT, 3);
    for (glm::vec3& point : points)
        point = glm::vec3(1e6f, 0, 0) + glm::vec3(glm::ivec3(point * 16.0f));
    Photons photons = make_floor_photons(points);
    LoupeQuery query;
    query.point = {1e6 + 0.25, 0, 0};
    query.k = 10;
    const LoupeView view = look_through_loupe(get_device(), photons, query);
    ASSERT_EQ(view.ids.size(), 10u);
    for (std::size_t i = 0; i < view.ids.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_EQ(view.positions[i][axis] + view.origin[axis], points[view.ids[i]][axis]);
}

TEST(Columns, list_says_what_is_missing_and_finding_it_throws_the_same) {
    Photons photons = make_floor_photons(draw_points(10, 4));
    std::size_t missing = 0;
    for (const ColumnInfo& info : list_columns(photons)) {
        if (info.missing.empty()) {
            EXPECT_EQ(find_column(get_device(), photons, info.name).values.size(), 10u) << info.name;
            continue;
        }
        ++missing;
        try {
            find_column(get_device(), photons, info.name);
            ADD_FAILURE() << info.name << " was found";
        } catch (const Error& error) {
            EXPECT_EQ(error.what(), "column '" + info.name + "': " + info.missing);
        }
    }
    EXPECT_GT(missing, 20u);
}

TEST(Columns, parameters_without_a_name_of_their_own_get_one) {
    Photons photons = make_floor_photons(draw_points(10, 5));
    photons.map.parameters =
        make_parameters(get_device(), std::vector<float>(30), {{"", 0, 1, 0}, {"x", 0, 1, 0}, {"x", 0, 1, 0}});
    std::vector<std::string> names;
    for (const ColumnInfo& info : list_columns(photons))
        names.push_back(info.name);
    EXPECT_EQ((std::vector(names.end() - 3, names.end())),
              (std::vector<std::string>{"parameter.3", "parameter.x", "parameter.5"}));
}

TEST(TakeRelaxed, carries_what_was_measured) {
    Workbench bench(get_device());
    Photons photons = make_layers();
    RelaxSettings settings;
    Relaxation relaxation = bench.start_relaxation(photons, nullptr, settings, {});
    relaxation.step({});
    const std::shared_ptr<Photons> relaxed = Workbench::take_relaxed(photons, relaxation.read());
    ASSERT_TRUE(relaxed->state);
    EXPECT_EQ(relaxed->state->basis.size(), 6 * COUNT);
    const Column drift = find_column(get_device(), *relaxed, "drift");
    EXPECT_GT(drift.high, 0.0f);
    LoupeQuery query;
    query.photon = 3;
    EXPECT_EQ(look_through_loupe(get_device(), *relaxed, query).ellipses.size(), 250u);
}

} // namespace
} // namespace photonloupe::test
