// SPDX-License-Identifier: Apache-2.0
// Trees whose nodes know ranges of layers and parameters: what each node claims is recomputed from its photons.
#include "photons/kd_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

// Photons with a layer and parameters each, as columns and as a map.
struct Photons {
    std::vector<glm::vec4> positions, normals;
    std::vector<std::vector<float>> values; // by photon: layer, parameters
    PhotonMap map;
    RangeRows ranges;
};

void upload(Photons& photons) {
    gpu::Device& device = get_device();
    photons.map.count = photons.positions.size();
    photons.map.position_emitter = gpu::make_buffer(device, photons.positions, "positions");
    photons.map.normal_index = gpu::make_buffer(device, photons.normals, "normals");
    std::vector<float> rows;
    const std::size_t stride = 4 * photons.ranges.count_rows();
    for (const std::vector<float>& values : photons.values) {
        rows.insert(rows.end(), values.begin(), values.end());
        rows.resize((rows.size() + stride - 1) / stride * stride);
    }
    photons.ranges.values = gpu::make_buffer(device, rows, "ranges");
}

Photons draw_photons(std::size_t count, std::uint32_t axes, std::uint32_t emitter_count = 1) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    Photons photons;
    photons.ranges.axis_count = axes;
    for (std::size_t i = 0; i < count; ++i) {
        photons.positions.emplace_back(normal(random), 0.3f * normal(random), normal(random),
                                       std::bit_cast<float>(static_cast<std::uint32_t>(5 + random() % emitter_count)));
        glm::vec3 n(normal(random), normal(random), normal(random));
        n /= std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) + 1e-6f;
        photons.normals.emplace_back(n, 0.0f);
        std::vector<float> values{static_cast<float>(random() % 3)};
        for (std::uint32_t axis = 1; axis < axes; ++axis)
            values.push_back(normal(random) * static_cast<float>(axis) - 5.0f);
        photons.values.push_back(values);
    }
    return photons;
}

// The tree as it was read back.
struct Read {
    TreeArrays arrays;
    std::vector<shared::TreeNode> nodes;
    std::vector<glm::vec4> positions, normals, normal_boxes, rows, ranges;
};

Read read(const KdTree& tree) {
    const std::uint64_t nodes = 2ull << tree.leaf_level;
    return {read_tree(tree),
            tree.nodes.read<shared::TreeNode>(nodes),
            tree.positions.read<glm::vec4>(tree.count),
            tree.normals.read<glm::vec4>(tree.count),
            tree.normal_boxes.read<glm::vec4>(2 * nodes),
            tree.rows.read<glm::vec4>(tree.count * tree.range_rows),
            tree.ranges.read<glm::vec4>(2 * nodes * tree.range_rows)};
}

// The integer in the last component: a photon's id or emitter.
std::uint32_t get_id(const glm::vec4& row) {
    return std::bit_cast<std::uint32_t>(row.w);
}

struct Bounds {
    glm::vec4 lo = glm::vec4(INFINITY), hi = glm::vec4(-INFINITY);
    void add(const glm::vec4& v) {
        for (int i = 0; i < 4; ++i) {
            lo[i] = std::min(lo[i], v[i]);
            hi[i] = std::max(hi[i], v[i]);
        }
    }
};

void expect_bounds(const Read& tree, std::size_t heap, std::uint32_t rows) {
    Bounds box, normals;
    std::vector<Bounds> ranges(rows);
    const std::int32_t first = tree.arrays.first[heap - 1], end = first + tree.arrays.count[heap - 1];
    for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(end); ++i) {
        box.add(tree.positions[i]);
        normals.add(tree.normals[i]);
        for (std::uint32_t row = 0; row < rows; ++row)
            ranges[row].add(tree.rows[i * rows + row]);
    }
    ASSERT_EQ(glm::vec3(tree.nodes[heap].lo_split), glm::vec3(box.lo)) << "node " << heap;
    ASSERT_EQ(glm::vec3(tree.nodes[heap].hi_axis), glm::vec3(box.hi)) << "node " << heap;
    ASSERT_EQ(glm::vec3(tree.normal_boxes[2 * heap]), glm::vec3(normals.lo)) << "node " << heap;
    ASSERT_EQ(glm::vec3(tree.normal_boxes[2 * heap + 1]), glm::vec3(normals.hi)) << "node " << heap;
    const auto least = std::min_element(tree.arrays.order.begin() + first, tree.arrays.order.begin() + end);
    ASSERT_EQ(std::bit_cast<std::int32_t>(tree.normal_boxes[2 * heap].w), *least) << "node " << heap;
    for (std::uint32_t row = 0; row < rows; ++row) {
        ASSERT_EQ(tree.ranges[2 * rows * heap + row], ranges[row].lo) << "node " << heap;
        ASSERT_EQ(tree.ranges[(2 * heap + 1) * rows + row], ranges[row].hi) << "node " << heap;
    }
}

// All photons of the left half are before all of the right one, ties by id; the split value is the right one's least.
void expect_order(const Photons& photons, const Read& tree, std::size_t heap, TreeAxes axes) {
    const int axis = tree.arrays.split_axis[heap - 1];
    const auto first = static_cast<std::size_t>(tree.arrays.first[heap - 1]);
    const auto middle = static_cast<std::size_t>(tree.arrays.first[2 * heap]);
    const std::size_t end = first + static_cast<std::size_t>(tree.arrays.count[heap - 1]);
    ASSERT_LT(axis, 3 + static_cast<int>(photons.ranges.axis_count));
    if (axes == TreeAxes::ranges)
        ASSERT_TRUE(axis == 0 || axis >= 3);
    const auto key = [&](std::size_t at) {
        const std::uint32_t id = get_id(tree.positions[at]);
        const float value =
            axis < 3 ? tree.positions[at][axis] : photons.values[id][static_cast<std::size_t>(axis - 3)];
        return std::pair(value, id);
    };
    auto last = key(first);
    for (std::size_t i = first; i < middle; ++i)
        last = std::max(last, key(i));
    auto next = key(middle);
    for (std::size_t i = middle; i < end; ++i)
        next = std::min(next, key(i));
    ASSERT_LT(last, next) << "node " << heap << ", axis " << axis;
    ASSERT_EQ(tree.arrays.split_value[heap - 1], next.first) << "node " << heap;
}

Read expect_sound(Photons& photons, TreeAxes axes) {
    upload(photons);
    const KdTree tree = build_tree(get_device(), photons.map, photons.ranges, axes);
    EXPECT_EQ(tree.range_rows, photons.ranges.count_rows());
    Read read_back = read(tree);
    std::set<std::uint32_t> ids;
    for (std::size_t i = 0; i < tree.count; ++i) {
        const std::uint32_t id = get_id(read_back.positions[i]);
        ids.insert(id);
        EXPECT_EQ(glm::vec3(read_back.positions[i]), glm::vec3(photons.positions.at(id)));
        EXPECT_EQ(glm::vec3(read_back.normals[i]), glm::vec3(photons.normals.at(id)));
        EXPECT_EQ(get_id(read_back.normals[i]), get_id(photons.positions.at(id))) << "emitter";
        for (std::size_t axis = 0; axis < photons.ranges.axis_count; ++axis)
            EXPECT_EQ(read_back.rows[i * tree.range_rows + axis / 4][static_cast<int>(axis % 4)],
                      photons.values.at(id)[axis]);
    }
    EXPECT_EQ(ids.size(), tree.count) << "each photon once";
    for (std::size_t heap = 1; heap <= read_back.arrays.count.size() && !testing::Test::HasFailure(); ++heap) {
        const bool is_leaf = heap >> tree.leaf_level;
        EXPECT_EQ(read_back.arrays.split_axis[heap - 1] < 0, is_leaf);
        if (is_leaf) {
            EXPECT_LE(read_back.arrays.count[heap - 1], 16);
            EXPECT_EQ(std::bit_cast<std::uint32_t>(read_back.nodes[heap].hi_axis.w), shared::TREE_LEAF);
        } else
            expect_order(photons, read_back, heap, axes);
        expect_bounds(read_back, heap, tree.range_rows);
    }
    return read_back;
}

class RangeTreeOfCount : public ::testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(, RangeTreeOfCount, ::testing::Values(0, 1, 8, 9, 16, 17, 129, 20'000, 50'000),
                         ::testing::PrintToStringParamName());

TEST_P(RangeTreeOfCount, is_sound) {
    for (const TreeAxes axes : {TreeAxes::both, TreeAxes::ranges}) {
        Photons photons = draw_photons(GetParam(), 5, axes == TreeAxes::both ? 1 : 3); // emitters
        expect_sound(photons, axes);
    }
}

TEST(RangeTree, knows_from_one_to_fourteen_axes) {
    for (const std::uint32_t axes : {1u, 4u, 8u, 14u}) {
        Photons photons = draw_photons(3000, axes);
        expect_sound(photons, TreeAxes::both);
        expect_sound(photons, TreeAxes::ranges);
    }
}

TEST(RangeTree, is_not_split_along_constant_axes) {
    Photons photons = draw_photons(3000, 4);
    for (std::size_t i = 0; i < photons.values.size(); ++i) {
        photons.values[i] = {2.0f, -1.5f, photons.values[i][2], 7.0f};
        photons.positions[i].y = 0.25f;
    }
    const Read both = expect_sound(photons, TreeAxes::both);
    for (const std::int8_t axis : both.arrays.split_axis)
        EXPECT_TRUE(axis == -1 || axis == 0 || axis == 2 || axis == 5) << int{axis};
    const Read ranges = expect_sound(photons, TreeAxes::ranges);
    for (const std::int8_t axis : ranges.arrays.split_axis)
        EXPECT_TRUE(axis == -1 || axis == 5) << int{axis};
}

TEST(RangeTree, of_photons_that_are_all_alike_is_sound) {
    Photons photons = draw_photons(3000, 4);
    for (std::size_t i = 0; i < photons.values.size(); ++i) {
        photons.values[i] = {1.0f, 2.0f, 3.0f, 4.0f};
        photons.positions[i] = {0.5f, 0.5f, -0.5f, 0.0f};
    }
    expect_sound(photons, TreeAxes::both);
    expect_sound(photons, TreeAxes::ranges);
}

TEST(RangeTree, full_of_ties_is_sound) {
    Photons photons = draw_photons(30'000, 6);
    for (std::vector<float>& values : photons.values)
        for (float& value : values)
            value = std::floor(value);
    expect_sound(photons, TreeAxes::ranges);
    expect_sound(photons, TreeAxes::both);
}

TEST(RangeTree, is_split_along_what_few_photons_differ_in_when_nothing_else_does) {
    Photons photons = draw_photons(3000, 2);
    for (std::size_t i = 0; i < photons.values.size(); ++i) {
        photons.positions[i] = {0.5f, 0.5f, 0.5f, 0.0f};
        photons.values[i] = {0.0f, i % 700 == 33 ? 4.0f : 1.0f};
    }
    const Read tree = expect_sound(photons, TreeAxes::both);
    EXPECT_EQ(tree.arrays.split_axis[0], 4);
}

TEST(RangeTree, keeps_a_small_layer_in_few_nodes) {
    constexpr std::size_t MINORITY = 10;
    Photons photons = draw_photons(100'000, 3);
    for (std::size_t i = 0; i < photons.values.size(); ++i)
        photons.values[i][0] = i % 10'000 == 77 ? 5.0f : 0.0f;
    for (const TreeAxes axes : {TreeAxes::both, TreeAxes::ranges}) {
        upload(photons);
        const KdTree built = build_tree(get_device(), photons.map, photons.ranges, axes);
        const Read tree = read(built);
        std::size_t mixed = 0, useless = 0;
        for (std::size_t heap = 1; heap <= tree.arrays.count.size(); ++heap) {
            mixed += tree.ranges[2 * heap].x < tree.ranges[2 * heap + 1].x;
            useless += tree.arrays.split_axis[heap - 1] == 3;
        }
        EXPECT_LE(mixed, 2 * (built.leaf_level + 1) * MINORITY);
        EXPECT_LE(useless, 3 * MINORITY) << "splits by the layer";
    }
}

TEST(RangeTree, has_layers_apart_where_they_are_many) {
    Photons photons = draw_photons(20'000, 3);
    const Read tree = expect_sound(photons, TreeAxes::both);
    std::size_t mixed = 0, leaves = 0;
    for (std::size_t heap = 1; heap <= tree.arrays.count.size(); ++heap)
        if (tree.arrays.split_axis[heap - 1] < 0) {
            ++leaves;
            mixed += tree.ranges[2 * heap].x < tree.ranges[2 * heap + 1].x;
        }
    EXPECT_LT(mixed, leaves / 3);
}

TEST(RangeTree, is_tight_again_after_photons_and_normals_moved) {
    Photons photons = draw_photons(5000, 5);
    upload(photons);
    const KdTree original = build_tree(get_device(), photons.map, photons.ranges, TreeAxes::both);
    KdTree tree = copy_tree(get_device(), original);
    Read moved = read(tree);
    std::mt19937 random(3);
    std::normal_distribution<float> shift;
    for (std::size_t i = 0; i < tree.count; ++i) {
        moved.positions[i].x += shift(random);
        moved.normals[i] = glm::vec4(moved.normals[i].y, -moved.normals[i].x, moved.normals[i].z, moved.normals[i].w);
    }
    tree.positions.upload(moved.positions.data(), moved.positions.size() * sizeof(glm::vec4));
    tree.normals.upload(moved.normals.data(), moved.normals.size() * sizeof(glm::vec4));
    refit_tree(get_device(), tree, "refit");
    const Read fitted = read(tree);
    for (std::size_t heap = 1; heap <= fitted.arrays.count.size() && !HasFailure(); ++heap)
        expect_bounds(fitted, heap, tree.range_rows);
    EXPECT_EQ(fitted.arrays.split_axis, moved.arrays.split_axis);
    EXPECT_EQ(fitted.arrays.split_value, moved.arrays.split_value);
    EXPECT_EQ(fitted.arrays.order, moved.arrays.order);
    const Read before = read(original);
    EXPECT_NE(before.positions, fitted.positions) << "the original stays";
}

TEST(RangeTree, is_the_same_when_its_buffers_go_by_address) {
    Photons photons = draw_photons(20'000, 5);
    const Read expected = expect_sound(photons, TreeAxes::both);
    const ScopedVariable range("PHOTONLOUPE_STORAGE_RANGE", "64");
    gpu::Device device;
    PhotonMap map;
    map.count = photons.map.count;
    map.position_emitter = gpu::make_buffer(device, photons.positions, "positions");
    map.normal_index = gpu::make_buffer(device, photons.normals, "normals");
    RangeRows rows;
    rows.axis_count = 5;
    rows.values = gpu::make_buffer(device, photons.ranges.values.read<glm::vec4>(2 * map.count), "ranges");
    const Read tree = read(build_tree(device, map, rows, TreeAxes::both));
    EXPECT_EQ(tree.arrays.order, expected.arrays.order);
    EXPECT_TRUE(std::equal(tree.ranges.begin() + 4, tree.ranges.end(), expected.ranges.begin() + 4)); // node 0 is none
}

} // namespace
} // namespace photonloupe::test
