// SPDX-License-Identifier: Apache-2.0
// The device's kd-tree against a naive twin built with std::nth_element: the same photons in every node.
#include "photons/kd_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <glm/vec3.hpp>

#include <gtest/gtest.h>

#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

using Points = std::vector<glm::vec3>;

TreeArrays build(gpu::Device& device, const Points& points) {
    std::vector<glm::vec4> positions, normals(points.size(), {0, 1, 0, 0}), powers(points.size(), {1, 1, 1, 0});
    for (const glm::vec3& point : points)
        positions.emplace_back(point, 0.0f);
    PhotonMap photons;
    photons.count = points.size();
    photons.position_emitter = gpu::make_buffer(device, positions, "positions");
    photons.normal_index = gpu::make_buffer(device, normals, "normals");
    photons.power_object = gpu::make_buffer(device, powers, "powers");
    return read_tree(build_tree(device, photons));
}

// The same arrays from the definition, a node after the other.
class Twin {
public:
    explicit Twin(const Points& points) : m_points(points) {
        m_tree.order.resize(points.size());
        std::iota(m_tree.order.begin(), m_tree.order.end(), 0);
        const std::uint32_t leaf_level = find_leaf_level(points.size());
        for (std::uint32_t level = 0; level <= leaf_level && !points.empty(); ++level)
            for (std::uint64_t node = 0; node < 1ull << level; ++node)
                add_node(level, node, level == leaf_level);
    }
    const TreeArrays& get_tree() const { return m_tree; }

private:
    void add_node(std::uint32_t level, std::uint64_t node, bool is_leaf) {
        const auto first = find_first(node, level);
        const auto end = find_first(node + 1, level);
        glm::vec3 lo(INFINITY), hi(-INFINITY);
        for (std::ptrdiff_t i = first; i < end; ++i)
            for (int axis = 0; axis < 3; ++axis) {
                lo[axis] = std::min(lo[axis], pick(m_tree.order[std::size_t(i)], axis));
                hi[axis] = std::max(hi[axis], pick(m_tree.order[std::size_t(i)], axis));
            }
        const glm::vec3 extent = hi - lo;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        float value = 0;
        if (!is_leaf) {
            const auto begin = m_tree.order.begin();
            const auto split = begin + find_first(2 * node + 1, level + 1);
            std::nth_element(begin + first, split, begin + end, [&](std::int32_t a, std::int32_t b) {
                return pick(a, axis) != pick(b, axis) ? pick(a, axis) < pick(b, axis) : a < b;
            });
            value = pick(*split, axis);
        }
        m_tree.split_axis.push_back(is_leaf ? std::int8_t{-1} : std::int8_t(axis));
        m_tree.split_value.push_back(value);
        m_tree.first.push_back(std::int32_t(first));
        m_tree.count.push_back(std::int32_t(end - first));
        m_tree.box.push_back({lo.x, lo.y, lo.z, hi.x, hi.y, hi.z});
    }

    // Whole tiles of eight are shared out.
    std::ptrdiff_t find_first(std::uint64_t node, std::uint32_t level) const {
        const std::uint64_t tiles = (m_points.size() + 7) / 8;
        return std::ptrdiff_t(std::min<std::uint64_t>(8 * (tiles * node >> level), m_points.size()));
    }

    float pick(std::int32_t photon, int axis) const { return m_points[std::size_t(photon)][axis]; }

    const Points& m_points;
    TreeArrays m_tree;
};

// Photon ids of every leaf, each leaf sorted.
std::vector<std::int32_t> sort_leaves(const TreeArrays& tree) {
    std::vector<std::int32_t> order = tree.order;
    for (std::size_t node = 0; node < tree.first.size(); ++node)
        if (tree.split_axis[node] < 0)
            std::sort(order.begin() + tree.first[node], order.begin() + tree.first[node] + tree.count[node]);
    return order;
}

void expect_twin(const Points& points, gpu::Device& device = get_device()) {
    const TreeArrays tree = build(device, points);
    const Twin twin(points);
    const TreeArrays& expected = twin.get_tree();
    ASSERT_EQ(tree.order.size(), points.size());
    ASSERT_EQ(tree.first, expected.first);
    ASSERT_EQ(tree.count, expected.count);
    EXPECT_TRUE(tree.split_axis == expected.split_axis) << "split axes differ";
    EXPECT_TRUE(tree.split_value == expected.split_value) << "split values differ";
    EXPECT_TRUE(tree.box == expected.box) << "boxes are not tight";
    EXPECT_TRUE(sort_leaves(tree) == sort_leaves(expected)) << "leaves hold other photons";
}

Points draw_points(std::size_t count, unsigned seed, float size = 1.0f) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-size, size);
    Points points(count);
    for (glm::vec3& point : points)
        for (int axis = 0; axis < 3; ++axis)
            point[axis] = place(random);
    return points;
}

class TreeOfCount : public ::testing::TestWithParam<std::size_t> {};
// Around the size of one leaf, of two and of four; then past what an invocation and what a subgroup splits alone.
// llvmpipe ends all loops of an invocation after 65,535 rounds together, without a word: the last two would need more
// if one subgroup of 8 passed over all photons a few times.
INSTANTIATE_TEST_SUITE_P(, TreeOfCount,
                         ::testing::Values(0, 1, 2, 31, 32, 33, 63, 64, 65, 127, 129, 1000, 8191, 16'384, 16'385,
                                           100'000, 200'000, 600'000),
                         ::testing::PrintToStringParamName());

TEST_P(TreeOfCount, equals_the_twin) {
    expect_twin(draw_points(GetParam(), 1));
}

TEST(Tree, holds_every_photon_once) {
    std::vector<std::int32_t> order = build(get_device(), draw_points(100'000, 2)).order;
    std::sort(order.begin(), order.end());
    std::vector<std::int32_t> ids(order.size());
    std::iota(ids.begin(), ids.end(), 0);
    EXPECT_TRUE(order == ids);
}

TEST(Tree, of_coincident_photons_equals_the_twin) {
    expect_twin(Points(5000, glm::vec3(0.1f, -0.2f, 0.3f)));
}

TEST(Tree, of_photons_on_one_line_equals_the_twin) {
    for (int axis = 0; axis < 3; ++axis) {
        Points points = draw_points(5000, 3);
        for (glm::vec3& point : points)
            point[(axis + 1) % 3] = point[(axis + 2) % 3] = 0.25f;
        expect_twin(points);
    }
}

TEST(Tree, of_photons_on_a_diagonal_equals_the_twin) {
    Points points = draw_points(5000, 4);
    for (glm::vec3& point : points)
        point = glm::vec3(point.x);
    expect_twin(points);
}

TEST(Tree, of_a_lattice_full_of_ties_equals_the_twin) {
    Points points = draw_points(20'000, 5, 4.0f);
    for (glm::vec3& point : points)
        for (int axis = 0; axis < 3; ++axis)
            point[axis] = std::floor(point[axis]);
    expect_twin(points);
}

// Nodes that several subgroups split (more than 16,384 photons).
TEST(Tree, of_large_nodes_full_of_ties_equals_the_twin) {
    Points points = draw_points(150'000, 11, 2.0f);
    for (glm::vec3& point : points)
        for (int axis = 0; axis < 3; ++axis)
            point[axis] = std::floor(point[axis]);
    expect_twin(points);
}

TEST(Tree, of_many_coincident_photons_equals_the_twin) {
    Points points(150'000, glm::vec3(0.5f));
    expect_twin(points);
    points[77] = glm::vec3(-7.0f, 100.0f, 3.0f);
    expect_twin(points);
}

TEST(Tree, of_a_periodic_order_that_samples_meet_in_step_equals_the_twin) {
    Points points = draw_points(200'000, 12);
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i].x = static_cast<float>(i % 64) + (i % 16 == 8 ? 1000.0f : 0.0f);
    expect_twin(points);
}

// A large node's 4,096 samples, every 48th photon from the 24th on, all lie where the median is not: it is sought
// again.
TEST(Tree, whose_samples_miss_the_median_equals_the_twin) {
    Points points = draw_points(std::size_t{4096} * 48, 14);
    for (std::size_t i = 24; i < points.size(); i += 48)
        points[i].x += 100.0f;
    expect_twin(points);
}

TEST(Tree, of_heavy_tails_equals_the_twin) {
    Points points = draw_points(150'000, 13);
    for (glm::vec3& point : points)
        point.x = std::copysign(std::exp(60.0f * point.x * point.x), point.x);
    expect_twin(points);
}

TEST(Tree, of_sorted_photons_equals_the_twin) {
    Points points = draw_points(120'000, 6);
    std::sort(points.begin(), points.end(), [](const glm::vec3& a, const glm::vec3& b) { return a.x < b.x; });
    expect_twin(points);
    std::reverse(points.begin(), points.end());
    expect_twin(points);
}

TEST(Tree, of_one_outlier_among_coincident_photons_equals_the_twin) {
    Points points(3000, glm::vec3(0.5f));
    points[1234] = glm::vec3(-7.0f, 100.0f, 3.0f);
    expect_twin(points);
}

TEST(Tree, of_tiny_and_of_huge_coordinates_equals_the_twin) {
    for (float size : {1e-40f, 1e-30f, 1e30f, 1e37f})
        expect_twin(draw_points(3000, 7, size));
}

TEST(Tree, of_photons_on_both_sides_of_signed_zero_equals_the_twin) {
    Points points = draw_points(3000, 8);
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i].y = i % 3 ? 0.0f : -0.0f;
    expect_twin(points);
}

TEST(Tree, is_the_same_when_its_buffers_go_by_address) {
    const ScopedVariable range("PHOTONLOUPE_STORAGE_RANGE", "64");
    gpu::Device device;
    expect_twin(draw_points(5000, 9), device);
}

TEST(Tree, is_the_same_when_its_buffers_are_staged) {
    const ScopedVariable forced("PHOTONLOUPE_FORCE_STAGING", "1");
    gpu::Device device;
    expect_twin(draw_points(5000, 9), device);
}

TEST(Tree, gives_the_same_bits_scaled_by_a_power_of_two) {
    for (float scale : {0x1p-20f, 0x1p20f}) {
        Points points = draw_points(5000, 10);
        const TreeArrays tree = build(get_device(), points);
        for (glm::vec3& point : points)
            point *= scale;
        const TreeArrays scaled = build(get_device(), points);
        EXPECT_TRUE(tree.order == scaled.order);
        EXPECT_EQ(tree.split_axis, scaled.split_axis);
    }
}

} // namespace
} // namespace photonloupe::test
