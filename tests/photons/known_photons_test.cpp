// SPDX-License-Identifier: Apache-2.0
// Maps that several threads ask, that share memory, and of which a part is taken.
#include "known_photons.h"

#include <thread>

#include <gtest/gtest.h>

#include "inspect/inspect_maps.h"

namespace photonloupe::test {
namespace {

constexpr std::uint32_t COUNT = 5000;

Photons make_layers() {
    const std::vector<glm::vec3> points = draw_points(COUNT, 1);
    Photons photons = make_floor_photons(points);
    std::vector<float> values;
    for (const glm::vec3& point : points)
        values.push_back(point.x);
    set_parameters(get_device(), photons, std::move(values), {{"east", -2, 2, 0}});
    return photons;
}

TEST(KnownPhotons, answer_threads_that_ask_at_once) {
    constexpr std::uint32_t K = 20;
    Photons photons = make_layers(), alone = make_layers();
    const std::vector<std::uint32_t> ids{0, 7, COUNT - 1};
    const auto ask = [&](Photons& asked, SearchSpace space) {
        return find_neighbors(get_device(), asked, {.space = space, .ids = ids, .k = K}, {})
            .ids.read<std::int32_t>(ids.size() * K);
    };
    const std::vector<SearchSpace> spaces{SearchSpace::constrained, SearchSpace::world, SearchSpace::parameter,
                                          SearchSpace::constrained};
    std::vector<std::vector<std::int32_t>> found(spaces.size());
    std::vector<std::shared_ptr<const KdTree>> trees(spaces.size());
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < spaces.size(); ++i)
        threads.emplace_back([&, i] {
            found[i] = ask(photons, spaces[i]);
            trees[i] = find_tree(get_device(), photons);
        });
    for (std::thread& thread : threads)
        thread.join();
    for (std::size_t i = 0; i < spaces.size(); ++i) {
        EXPECT_EQ(found[i], ask(alone, spaces[i])) << i;
        EXPECT_EQ(trees[i], trees[0]) << "built twice";
    }
}

TEST(KnownPhotons, share_what_they_are_until_one_gets_other_parameters) {
    Photons photons = make_layers();
    const std::shared_ptr<Photons> other = share_photons(photons);
    EXPECT_EQ(other->map.position_emitter.mapped(), photons.map.position_emitter.mapped());
    set_parameters(get_device(), *other, std::vector<float>(COUNT, 3.0f), {{"three", 0, 5, 0}});
    EXPECT_EQ(photons.map.parameters->axes[0].name, "east");
    EXPECT_EQ((*other->map.parameters->given)[7], 3.0f);
}

TEST(KnownPhotons, part_keeps_the_rows_of_its_photons) {
    const Photons photons = make_layers();
    const std::vector<std::uint32_t> ids{9, 4, 9};
    const std::shared_ptr<Photons> some = select_photons(get_device(), photons, ids);
    ASSERT_EQ(some->map.count, ids.size());
    const std::vector<float> all = read_positions(photons.map), part = read_positions(some->map);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        EXPECT_EQ(part[3 * i], all[3 * ids[i]]);
        EXPECT_EQ((*some->map.parameters->given)[i], (*photons.map.parameters->given)[ids[i]]);
    }
}

} // namespace
} // namespace photonloupe::test
