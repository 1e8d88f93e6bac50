// SPDX-License-Identifier: Apache-2.0
// The BVH's invariants, and its hits against brute force in double precision.
#include "scene/bvh.h"

#include <bit>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <gtest/gtest.h>

namespace photonloupe::test {
namespace {

using Triangles = std::vector<shared::Triangle>;
using Nodes = std::vector<shared::BvhNode>;

shared::Triangle make_triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c, std::uint32_t id) {
    return {{a, 0.0f}, {b, 0.0f}, {c, std::bit_cast<float>(id)}};
}

std::uint32_t get_id(const shared::Triangle& triangle) {
    return std::bit_cast<std::uint32_t>(triangle.v2_source.w);
}
std::uint32_t get_first(const shared::BvhNode& node) {
    return std::bit_cast<std::uint32_t>(node.lo_first.w);
}
std::uint32_t get_count(const shared::BvhNode& node) {
    return std::bit_cast<std::uint32_t>(node.hi_count.w);
}

class Random {
public:
    explicit Random(unsigned seed) : m_engine(seed) {}
    float draw(float lo, float hi) { return lo + (hi - lo) * float(m_engine() % 65536u) / 65536.0f; }
    glm::vec3 draw_point(float size) {
        const float x = draw(-size, size), y = draw(-size, size), z = draw(-size, size);
        return {x, y, z};
    }

private:
    std::mt19937 m_engine;
};

Triangles make_random(std::size_t count, float size, unsigned seed) {
    Random random(seed);
    Triangles triangles;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 center = random.draw_point(1.0f);
        const glm::vec3 a = random.draw_point(size), b = random.draw_point(size), c = random.draw_point(size);
        triangles.push_back(make_triangle(center + a, center + b, center + c, std::uint32_t(i)));
    }
    return triangles;
}

// Slivers of 10^6 : 1, duplicates, huge among tiny, coincident centers, and sizes that grow without end.
Triangles make_nasty() {
    Triangles triangles = make_random(200, 0.05f, 7);
    const auto add = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c) {
        triangles.push_back(make_triangle(a, b, c, std::uint32_t(triangles.size())));
    };
    for (int i = 0; i < 100; ++i) {
        const float x = float(i) * 0.02f - 1.0f;
        add({x, -1, 0}, {x + 1e-6f, 1, 0}, {x, 1, 0});
        add({-1, -1, 0.5f}, {1, -1, 0.5f}, {0, 1, 0.5f});
        add({-1, 0, float(i)}, {1, 0, float(-i)}, {0, 1, 0});
        const float size = std::ldexp(1.0f, i - 50);
        add({-size, -size, 0.25f}, {size, -size, 0.25f}, {0, 2 * size, 0.25f});
        add({size, size, -0.25f}, {3 * size, size, -0.25f}, {size, 3 * size, -0.25f});
    }
    return triangles;
}

struct Tree {
    Triangles triangles;
    Nodes nodes;
};

Tree build(Triangles triangles) {
    Scene scene;
    scene.triangles = std::move(triangles);
    build_bvh(scene);
    return {std::move(scene.triangles), std::move(scene.nodes)};
}

bool is_inside(const shared::BvhNode& outer, glm::vec3 lo, glm::vec3 hi) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(lo[axis] >= outer.lo_first[axis] && hi[axis] <= outer.hi_count[axis]))
            return false;
    return true;
}

// Walks the tree, counts visits of triangles and returns the depth of the deepest leaf.
std::uint32_t check_tree(const Tree& tree) {
    std::vector<int> visits(tree.triangles.size(), 0);
    std::uint32_t deepest = 0;
    std::set<std::uint32_t> seen{0};
    const std::function<void(std::uint32_t, std::uint32_t)> walk = [&](std::uint32_t index, std::uint32_t depth) {
        const shared::BvhNode& node = tree.nodes.at(index);
        deepest = std::max(deepest, depth);
        EXPECT_LE(get_count(node), BVH_MAX_LEAF_TRIANGLES);
        for (std::uint32_t i = get_first(node); i < get_first(node) + get_count(node); ++i) {
            ++visits.at(i);
            const shared::Triangle& t = tree.triangles[i];
            for (const shared::vec4& v : {t.v0_object, t.v1_material, t.v2_source})
                EXPECT_TRUE(is_inside(node, glm::vec3(v), glm::vec3(v)));
        }
        for (std::uint32_t child = get_first(node); get_count(node) == 0 && child < get_first(node) + 2; ++child) {
            EXPECT_TRUE(seen.insert(child).second) << "node " << child << " has two parents";
            const shared::BvhNode& inner = tree.nodes.at(child);
            EXPECT_TRUE(is_inside(node, glm::vec3(inner.lo_first), glm::vec3(inner.hi_count)));
            walk(child, depth + 1);
        }
    };
    walk(0, 0);
    EXPECT_EQ(seen.size(), tree.nodes.size());
    EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), std::ptrdiff_t(visits.size()));
    return deepest;
}

constexpr double MISS = std::numeric_limits<double>::infinity();

double intersect(const shared::Triangle& t, glm::dvec3 origin, glm::dvec3 direction) {
    const glm::dvec3 v0(t.v0_object), e1 = glm::dvec3(t.v1_material) - v0, e2 = glm::dvec3(t.v2_source) - v0;
    const glm::dvec3 p = glm::cross(direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0)
        return MISS;
    const glm::dvec3 s = origin - v0, q = glm::cross(s, e1);
    const double u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant;
    const double distance = glm::dot(e2, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && distance > 0 ? distance : MISS;
}

// Conservative by far more than double's rounding, so that a hit on a flat box's face is never lost.
bool meets_box(const shared::BvhNode& node, glm::dvec3 origin, glm::dvec3 direction) {
    double near = 0.0, far = MISS;
    for (int axis = 0; axis < 3; ++axis) {
        const double slack =
            1e-9 * (1.0 + std::abs(origin[axis]) + std::abs(node.hi_count[axis] - node.lo_first[axis]));
        const double lo = double(node.lo_first[axis]) - slack - origin[axis];
        const double hi = double(node.hi_count[axis]) + slack - origin[axis];
        if (direction[axis] == 0) {
            if (lo > 0 || hi < 0)
                return false;
            continue;
        }
        near = std::max(near, std::min(lo / direction[axis], hi / direction[axis]));
        far = std::min(far, std::max(lo / direction[axis], hi / direction[axis]));
    }
    return near <= far;
}

double trace(const Tree& tree, glm::dvec3 origin, glm::dvec3 direction) {
    double nearest = MISS;
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
        EXPECT_LE(stack.size(), shared::BVH_STACK_SIZE);
        const shared::BvhNode& node = tree.nodes[stack.back()];
        stack.pop_back();
        if (!meets_box(node, origin, direction))
            continue;
        if (get_count(node) == 0) {
            stack.push_back(get_first(node));
            stack.push_back(get_first(node) + 1);
        }
        for (std::uint32_t i = get_first(node); i < get_first(node) + get_count(node); ++i)
            nearest = std::min(nearest, intersect(tree.triangles[i], origin, direction));
    }
    return nearest;
}

void expect_hits_of_brute_force(const Tree& tree, unsigned seed) {
    Random random(seed);
    int hits = 0;
    for (int ray = 0; ray < 2000; ++ray) {
        const glm::dvec3 origin(random.draw_point(2.0f));
        glm::dvec3 direction = glm::dvec3(random.draw_point(1.0f)) - 0.3 * origin;
        if (ray % 10 == 0)
            direction[ray % 3] = 0.0;
        double nearest = MISS;
        for (const shared::Triangle& triangle : tree.triangles)
            nearest = std::min(nearest, intersect(triangle, origin, direction));
        EXPECT_EQ(trace(tree, origin, direction), nearest) << "ray " << ray;
        hits += nearest < MISS;
    }
    EXPECT_GT(hits, 200);
}

TEST(bvh, no_triangles_give_no_nodes) {
    EXPECT_TRUE(build({}).nodes.empty());
}

TEST(bvh, one_triangle_gives_one_leaf) {
    const Tree tree = build({make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0)});
    ASSERT_EQ(tree.nodes.size(), 1u);
    EXPECT_EQ(get_count(tree.nodes[0]), 1u);
    check_tree(tree);
}

TEST(bvh, random_triangles_are_each_in_one_leaf_inside_its_boxes) {
    check_tree(build(make_random(5000, 0.1f, 1)));
}

TEST(bvh, nasty_triangles_are_each_in_one_leaf_inside_its_boxes) {
    check_tree(build(make_nasty()));
}

TEST(bvh, rays_hit_random_triangles_as_brute_force_says) {
    expect_hits_of_brute_force(build(make_random(1000, 0.1f, 2)), 3);
}

TEST(bvh, rays_hit_nasty_triangles_as_brute_force_says) {
    expect_hits_of_brute_force(build(make_nasty()), 4);
}

TEST(bvh, coincident_triangles_are_halved_in_their_order) {
    Triangles triangles;
    for (std::uint32_t i = 0; i < 1000; ++i)
        triangles.push_back(make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, i));
    const Tree tree = build(triangles);
    EXPECT_LE(check_tree(tree), 7u); // 1000 / 2^7 < 8
    for (std::uint32_t i = 0; i < 1000; ++i)
        EXPECT_EQ(get_id(tree.triangles[i]), i);
}

TEST(bvh, the_depth_is_capped_where_surface_areas_peel_one_triangle_at_a_time) {
    Triangles triangles;
    for (std::uint32_t i = 0; i < 240; ++i) { // centers at powers of two over the whole range of floats
        const float x = std::ldexp(1.0f, int(i) - 140);
        triangles.push_back(make_triangle({x, 0, 0}, {x, x * 0.01f, 0}, {x, 0, x * 0.01f}, i));
    }
    EXPECT_LE(check_tree(build(triangles)), BVH_MAX_DEPTH);
}

TEST(bvh, the_same_triangles_give_the_same_tree_at_every_power_of_two) {
    const Triangles triangles = make_nasty();
    const Tree tree = build(triangles);
    for (const int exponent : {-20, 20}) {
        const float scale = std::ldexp(1.0f, exponent);
        Triangles scaled = triangles;
        for (shared::Triangle& t : scaled)
            for (shared::vec4* v : {&t.v0_object, &t.v1_material, &t.v2_source})
                *v = {glm::vec3(*v) * scale, v->w};
        const Tree other = build(scaled);
        ASSERT_EQ(other.nodes.size(), tree.nodes.size());
        for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
            EXPECT_EQ(glm::vec3(other.nodes[i].lo_first), glm::vec3(tree.nodes[i].lo_first) * scale);
            EXPECT_EQ(get_first(other.nodes[i]), get_first(tree.nodes[i]));
            EXPECT_EQ(get_count(other.nodes[i]), get_count(tree.nodes[i]));
        }
    }
}

TEST(bvh, what_corners_hold_moves_with_their_triangles) {
    Scene scene;
    scene.triangles = make_random(500, 0.1f, 5);
    scene.normals.resize(500);
    scene.corner_coordinates.resize(500);
    scene.corner_colors.resize(500);
    for (std::uint32_t i = 0; i < 500; ++i)
        scene.normals[i].n0.x = scene.corner_coordinates[i].c2.y = scene.corner_colors[i].c1.w = float(i);
    build_bvh(scene);
    for (std::size_t i = 0; i < 500; ++i) {
        const auto id = float(get_id(scene.triangles[i]));
        EXPECT_EQ(scene.normals[i].n0.x, id);
        EXPECT_EQ(scene.corner_coordinates[i].c2.y, id);
        EXPECT_EQ(scene.corner_colors[i].c1.w, id);
    }
}

TEST(bvh, a_million_triangles_build_within_the_deadline) {
    const auto start = std::chrono::steady_clock::now();
    const Tree tree = build(make_random(1'000'000, 0.005f, 6));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    RecordProperty("seconds", std::to_string(seconds));
    EXPECT_LT(seconds, 60.0); // a loose bound: the benchmark measures, this only catches quadratic behavior
    EXPECT_FALSE(tree.nodes.empty());
}

} // namespace
} // namespace photonloupe::test
