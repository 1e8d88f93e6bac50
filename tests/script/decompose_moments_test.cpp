// SPDX-License-Identifier: Apache-2.0
// Decomposition of moments: known shapes, signs of the axes, and when there is none.
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "script/interpret/reductions.h"

namespace photonloupe::script {
namespace {

using Points = std::vector<std::array<float, 3>>;

Moments push_all(const Points& points, std::size_t dimensions) {
    Moments moments;
    for (std::size_t i = 0; i < points.size(); ++i)
        push_point(moments, std::span(points[i]).first(dimensions), std::uint32_t(i));
    return moments;
}

Decomposition decompose(const Points& points, std::int32_t dimensions) {
    Decomposition decomposition;
    EXPECT_TRUE(decompose_moments(push_all(points, dimensions), dimensions, decomposition));
    EXPECT_EQ(decomposition.dimensions, dimensions);
    return decomposition;
}

TEST(Decomposition, a_line_in_the_plane_is_its_own_axis) {
    const Decomposition found = decompose({{0, 0, 0}, {3, 4, 0}}, 2);
    EXPECT_FLOAT_EQ(found.eigenvalues[0], 6.25f); // (5/2)², over both points
    EXPECT_NEAR(found.eigenvalues[1], 0, 1e-6);
    EXPECT_FLOAT_EQ(found.eigenvectors[0][0], 0.6f);
    EXPECT_FLOAT_EQ(found.eigenvectors[0][1], 0.8f);
    EXPECT_FLOAT_EQ(found.mean[0], 1.5f);
    EXPECT_FLOAT_EQ(found.mean[1], 2.0f);
}

TEST(Decomposition, axes_point_towards_the_first_point) {
    const Decomposition found = decompose({{-3, -4, 0}, {3, 4, 0}}, 2);
    EXPECT_FLOAT_EQ(found.eigenvectors[0][0], -0.6f);
    EXPECT_FLOAT_EQ(found.eigenvectors[0][1], -0.8f);
}

TEST(Decomposition, an_axis_across_the_first_point_points_towards_x_then_y) {
    const Decomposition flat = decompose({{0, 0, 0}, {-2, 0, 0}}, 2);
    EXPECT_FLOAT_EQ(flat.eigenvectors[0][0], 1);
    const Decomposition upright = decompose({{0, 0, 0}, {0, -2, 0}}, 2);
    EXPECT_FLOAT_EQ(upright.eigenvectors[0][1], 1);
}

TEST(Decomposition, an_axis_of_space_across_the_first_point_points_towards_z) {
    EXPECT_FLOAT_EQ(decompose({{0, 0, 0}, {0, 0, -2}}, 3).eigenvectors[0][2], 1);
}

TEST(Decomposition, a_square_has_two_equal_eigenvalues) {
    const Decomposition found = decompose({{1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}}, 2);
    EXPECT_FLOAT_EQ(found.eigenvalues[0], 1);
    EXPECT_FLOAT_EQ(found.eigenvalues[1], 1);
    EXPECT_FLOAT_EQ(std::hypot(found.eigenvectors[0][0], found.eigenvectors[0][1]), 1); // any direction
}

TEST(Decomposition, there_is_none_of_fewer_than_two_points_or_equal_ones) {
    Decomposition found;
    EXPECT_FALSE(decompose_moments({}, 2, found));
    EXPECT_FALSE(decompose_moments(push_all({{1, 2, 0}}, 2), 2, found));
    EXPECT_FALSE(decompose_moments(push_all(Points(7, {0.1f, 0.3f, 0.7f}), 2), 2, found));
    EXPECT_FALSE(decompose_moments(push_all(Points(7, {0.1f, 0.3f, 0.7f}), 3), 3, found));
    EXPECT_EQ(found.dimensions, 0);
}

TEST(Decomposition, there_is_none_where_a_point_is_not_finite) {
    Decomposition found;
    for (float bad : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(), 3e38f})
        EXPECT_FALSE(decompose_moments(push_all({{1, 2, 0}, {bad, 1, 0}, {-bad, 1, 0}}, 2), 2, found)) << bad;
}

TEST(Decomposition, a_failed_one_forgets_the_one_before) {
    Decomposition found = decompose({{0, 0, 0}, {3, 4, 0}}, 2);
    EXPECT_FALSE(decompose_moments({}, 2, found));
    EXPECT_EQ(found.dimensions, 0);
}

TEST(Decomposition, tiny_and_huge_points_keep_their_axes) {
    for (float scale : {1e-15f, 1e-3f, 1e15f}) {
        const Decomposition found = decompose({{0, 0, 0}, {3 * scale, 4 * scale, 0}}, 2);
        EXPECT_NEAR(found.eigenvectors[0][1], 0.8f, 1e-6) << scale;
    }
}

// A v = λ v for random clouds, largest first, axes orthonormal.
TEST(Decomposition, eigenvectors_of_space_satisfy_their_equation) {
    std::mt19937 random(11);
    std::normal_distribution<float> normal;
    for (int round = 0; round < 200; ++round) {
        Points points(20);
        const float flatness = std::pow(10.0f, -float(round % 5));
        for (auto& point : points)
            point = {normal(random), normal(random) * flatness + normal(random) * 0.1f, normal(random)};
        const Moments moments = push_all(points, 3);
        const Decomposition found = decompose(points, 3);
        const float (&p)[6] = moments.products;
        const float matrix[3][3] = {{p[0], p[1], p[2]}, {p[1], p[3], p[4]}, {p[2], p[4], p[5]}};
        EXPECT_GE(found.eigenvalues[0], found.eigenvalues[1]);
        EXPECT_GE(found.eigenvalues[1], found.eigenvalues[2]);
        for (int i = 0; i < 3; ++i) {
            float along_first = 0;
            for (int row = 0; row < 3; ++row) {
                float product = 0;
                for (int column = 0; column < 3; ++column)
                    product += matrix[row][column] * found.eigenvectors[i][column] / 20.0f;
                EXPECT_NEAR(product, found.eigenvalues[i] * found.eigenvectors[i][row], 2e-6 * found.eigenvalues[0]);
                along_first += found.eigenvectors[i][row] * points[0][row];
            }
            EXPECT_GE(along_first, -1e-6f);
            for (int j = 0; j <= i; ++j) {
                float dot = 0;
                for (int k = 0; k < 3; ++k)
                    dot += found.eigenvectors[i][k] * found.eigenvectors[j][k];
                EXPECT_NEAR(dot, i == j, 1e-6);
            }
        }
    }
}

} // namespace
} // namespace photonloupe::script
