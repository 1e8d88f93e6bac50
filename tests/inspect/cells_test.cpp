// SPDX-License-Identifier: Apache-2.0
// Surfaces seen, Voronoi and kd-tree cells: against closed forms and brute force.
#include <algorithm>
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "inspect/inspect_maps.h"
#include "inspect/kd_cells.h"
#include "inspect/voronoi.h"

namespace photonloupe::test {
namespace {

using namespace inspect;

constexpr std::uint32_t SIDE = 96;
// Of two squared distances of about 1 m², added in different orders.
constexpr double ROUNDING = 1e-5;

SurfaceView see(const Scene& scene, const shared::CameraFrame& camera = look_down(), std::uint32_t side = SIDE,
                bool sees_through = false) {
    return see_surfaces(get_device(), scene, upload_scene(get_device(), scene), camera, {side, side, sees_through});
}

CellImage find_cells(const Photons& photons, const SurfaceView& view, float flatness) {
    const KdTree tree = build_tree(get_device(), photons.map);
    return find_voronoi_cells(get_device(), photons.map, tree, view, {flatness});
}

// The radius of METHODS §2 that takes a photon in, squared; infinite for one that faces another way.
double measure(const glm::vec3& point, const glm::vec3& normal, const glm::vec3& photon, const glm::vec3& facing,
               double flatness) {
    const glm::dvec3 away = glm::dvec3(photon) - glm::dvec3(point);
    const double squared = glm::dot(away, away);
    if (flatness == 0)
        return squared;
    const double height = glm::dot(glm::dvec3(normal), away) / flatness;
    return glm::dot(glm::dvec3(normal), glm::dvec3(facing)) > 0.7 ? std::max(squared, height * height) : INFINITY;
}

TEST(SurfaceView, has_the_points_where_rays_meet_the_floor) {
    const SurfaceView view = see(make_floor());
    const double step = 2.0 / SIDE;
    for (std::uint32_t row = 0; row < SIDE; row += 5)
        for (std::uint32_t column = 0; column < SIDE; column += 7) {
            const std::optional<SurfacePoint> seen = read_surface(view, column, row);
            ASSERT_TRUE(seen);
            EXPECT_NEAR(seen->position[0], -1 + (column + 0.5) * step, 1e-6);
            EXPECT_NEAR(seen->position[1], 0.0, 1e-6);
            EXPECT_NEAR(seen->position[2], -1 + (row + 0.5) * step, 1e-6);
            EXPECT_NEAR(seen->depth, 2.0, 1e-6);
            EXPECT_EQ(seen->normal, glm::vec3(0, 1, 0));
            EXPECT_EQ(seen->object, 0);
        }
    EXPECT_FALSE(read_surface(view, SIDE, 0));
}

TEST(SurfaceView, says_where_nothing_is_seen) {
    shared::CameraFrame up = look_down();
    up.forward = {0, 1, 0, 0};
    EXPECT_FALSE(read_surface(see(make_floor(), up), SIDE / 2, SIDE / 2));
}

// A pane of glass half a metre above the floor, over its half towards -x.
Scene make_covered_floor() {
    Scene scene = make_scene({{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}}},
                              {{{-1, 0, -1}, {1, 0, 1}, {1, 0, -1}}},
                              {{{-1, 0.5f, -1}, {-1, 0.5f, 1}, {0, 0.5f, 1}}},
                              {{{-1, 0.5f, -1}, {0, 0.5f, 1}, {0, 0.5f, -1}}}});
    scene.materials.resize(2);
    scene.materials[1].emission_transmission.w = 1.0f;
    for (shared::Triangle& triangle : scene.triangles)
        if (triangle.v0_object.y > 0)
            triangle.v1_material.w = std::bit_cast<float>(1u);
    return scene;
}

TEST(SurfaceView, looks_through_glass_when_asked_to) {
    const Scene scene = make_covered_floor();
    const SurfaceView onto = see(scene), through = see(scene, look_down(), SIDE, true);
    const std::uint32_t under_glass = SIDE / 4;
    EXPECT_NEAR(read_surface(onto, under_glass, SIDE / 2)->position[1], 0.5, 1e-6);
    EXPECT_NEAR(read_surface(through, under_glass, SIDE / 2)->position[1], 0.0, 1e-6);
    EXPECT_NEAR(read_surface(through, under_glass, SIDE / 2)->depth, 2.0, 1e-6);
    EXPECT_NEAR(read_surface(onto, SIDE - 1, SIDE / 2)->depth, 2.0, 1e-6);
}

class ScaledVoronoi : public ::testing::TestWithParam<float> {};

TEST_P(ScaledVoronoi, has_the_same_cells) {
    const auto find = [](float scale) {
        std::vector<glm::vec3> positions = draw_points(2000, 9);
        for (glm::vec3& position : positions)
            position = {position.x * scale, 0, position.z * scale};
        const Scene scene = make_scene({{{{-scale, 0, -scale}, {-scale, 0, scale}, {scale, 0, scale}}},
                                        {{{-scale, 0, -scale}, {scale, 0, scale}, {scale, 0, -scale}}}});
        shared::CameraFrame camera = look_down();
        camera.position.y *= scale;
        return find_cells(make_floor_photons(positions), see(scene, camera), 0.1f);
    };
    EXPECT_EQ(find(GetParam()).ids, find(1.0f).ids);
}

INSTANTIATE_TEST_SUITE_P(Scales, ScaledVoronoi, ::testing::Values(0x1p-20f, 0x1p20f));

TEST(Voronoi, cells_of_a_grid_are_its_squares) {
    constexpr int CELLS = 8;
    std::vector<glm::vec3> grid;
    for (int row = 0; row < CELLS; ++row)
        for (int column = 0; column < CELLS; ++column)
            grid.emplace_back(-1 + (column + 0.5f) * 2 / CELLS, 0, -1 + (row + 0.5f) * 2 / CELLS);
    const CellImage image = find_cells(make_floor_photons(grid), see(make_floor()), 0.1f);
    const auto expected = [](std::uint32_t column, std::uint32_t row) {
        return static_cast<int>(row * CELLS / SIDE * CELLS + column * CELLS / SIDE);
    };
    for (std::uint32_t row = 0; row < SIDE; ++row)
        for (std::uint32_t column = 0; column < SIDE; ++column) {
            ASSERT_EQ(image.ids[row * SIDE + column], expected(column, row)) << row << ", " << column;
            const bool is_last = (column + 1) % (SIDE / CELLS) == 0 && column + 1 < SIDE;
            const bool is_lowest = (row + 1) % (SIDE / CELLS) == 0 && row + 1 < SIDE;
            ASSERT_EQ(image.is_border[row * SIDE + column] != 0, is_last || is_lowest) << row << ", " << column;
        }
}

class VoronoiOfFlatness : public ::testing::TestWithParam<float> {};

TEST_P(VoronoiOfFlatness, has_the_nearest_photon_of_each_pixel) {
    const std::vector<glm::vec3> positions = draw_points(3000, 3);
    std::vector<glm::vec3> normals = draw_points(3000, 4);
    for (glm::vec3& normal : normals)
        normal = glm::normalize(normal);
    const SurfaceView view = see(make_floor());
    const CellImage image = find_cells(make_photons(positions, normals), view, GetParam());
    const auto points = view.points.read<glm::vec4>(view.pixel_count());
    std::size_t checked = 0;
    for (std::size_t pixel = 0; pixel < points.size(); pixel += 13, ++checked) {
        const auto of = [&](std::size_t id) {
            return measure(glm::vec3(points[pixel]), {0, 1, 0}, positions[id], normals[id], GetParam());
        };
        double least = INFINITY;
        for (std::size_t id = 0; id < positions.size(); ++id)
            least = std::min(least, of(id));
        ASSERT_GE(image.ids[pixel], 0);
        ASSERT_LE(of(static_cast<std::size_t>(image.ids[pixel])), least * (1 + ROUNDING)) << "pixel " << pixel;
    }
    EXPECT_GT(checked, 500u);
}

INSTANTIATE_TEST_SUITE_P(Flatness, VoronoiOfFlatness, ::testing::Values(0.0f, 0.1f));

TEST(Voronoi, is_nobodys_where_all_photons_face_another_way) {
    const std::vector<glm::vec3> positions = draw_points(2000, 5);
    const Photons photons = make_photons(positions, std::vector<glm::vec3>(2000, glm::vec3(1, 0, 0)));
    const CellImage image = find_cells(photons, see(make_floor()), 0.1f);
    EXPECT_EQ(std::count(image.ids.begin(), image.ids.end(), -1), SIDE * SIDE);
    EXPECT_EQ(std::count(image.is_border.begin(), image.is_border.end(), 1), 0);
}

TEST(Voronoi, of_coincident_photons_is_the_first_ones_however_long_the_walk) {
    const Photons photons = make_floor_photons(std::vector<glm::vec3>(150'000, glm::vec3(0.25f, 0, 0.5f)));
    const CellImage image = find_cells(photons, see(make_floor(), look_down(), 8), 0.1f);
    EXPECT_EQ(std::count(image.ids.begin(), image.ids.end(), 0), 8 * 8);
}

TEST(Voronoi, does_not_depend_on_the_maps_origin) {
    std::vector<glm::vec3> positions = draw_points(500, 6);
    for (glm::vec3& position : positions)
        position = {position.x * 0.01f + 0.75f, 0, position.z * 0.01f}; // far from its own middle: kept relative to it
    const Photons photons = make_floor_photons(positions);
    ASSERT_NE(photons.map.origin, (std::array<double, 3>{}));
    const SurfaceView view = see(make_floor());
    const CellImage image = find_cells(photons, view, 0.0f);
    const auto points = view.points.read<glm::vec4>(view.pixel_count());
    for (std::size_t pixel = 0; pixel < points.size(); pixel += 31) {
        const auto of = [&](std::size_t id) { return glm::distance(glm::vec3(points[pixel]), positions[id]); };
        float least = INFINITY;
        for (std::size_t id = 0; id < positions.size(); ++id)
            least = std::min(least, of(id));
        ASSERT_LE(of(static_cast<std::size_t>(image.ids[pixel])), least * (1 + ROUNDING)) << "pixel " << pixel;
    }
}

TEST(Cells, of_an_empty_map_are_nobodys) {
    const Photons photons = make_floor_photons({});
    const SurfaceView view = see(make_floor());
    const KdTree tree = build_tree(get_device(), photons.map);
    for (const CellImage& image : {find_voronoi_cells(get_device(), photons.map, tree, view),
                                   find_kd_cells(get_device(), photons.map, tree, view)})
        EXPECT_EQ(std::count(image.ids.begin(), image.ids.end(), -1), SIDE * SIDE);
    EXPECT_TRUE(list_node_boxes(tree).empty());
}

TEST(KdCells, are_those_that_the_splits_lead_to) {
    const SurfaceView view = see(make_floor());
    const auto points = view.points.read<glm::vec4>(view.pixel_count());
    // Photons where pixels meet the floor: splits then pass through the points of others, which belong to their right.
    std::vector<glm::vec3> positions;
    for (std::size_t pixel = 0; pixel < points.size(); pixel += 2)
        positions.emplace_back(points[pixel]);
    const Photons photons = make_floor_photons(positions);
    const KdTree tree = build_tree(get_device(), photons.map);
    const TreeArrays arrays = read_tree(tree);
    std::size_t on_splits = 0;
    for (const std::uint32_t depth : {0u, 1u, 4u, 30u}) {
        const CellImage image = find_kd_cells(get_device(), photons.map, tree, view, depth);
        for (std::size_t pixel = 0; pixel < points.size(); ++pixel) {
            std::size_t row = 0;
            for (std::uint32_t level = 0; level < depth && arrays.split_axis[row] >= 0; ++level) {
                const float coordinate = points[pixel][arrays.split_axis[row]];
                on_splits += coordinate == arrays.split_value[row];
                row = 2 * row + 1 + (coordinate >= arrays.split_value[row]);
            }
            ASSERT_EQ(image.ids[pixel], static_cast<int>(row)) << "depth " << depth << ", pixel " << pixel;
        }
    }
    EXPECT_GT(on_splits, 100u);
}

TEST(KdCells, boxes_are_those_of_the_tree) {
    const Photons photons = make_floor_photons(draw_points(1000, 8));
    const KdTree tree = build_tree(get_device(), photons.map);
    const TreeArrays arrays = read_tree(tree);
    int sum = 0;
    for (const NodeBox& box : list_node_boxes(tree, 3)) {
        const std::array<float, 6>& expected = arrays.box[static_cast<std::size_t>(box.node)];
        EXPECT_EQ((std::array{box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z}), expected);
        EXPECT_EQ(box.photon_count, arrays.count[static_cast<std::size_t>(box.node)]);
        sum += box.photon_count;
    }
    EXPECT_EQ(sum, 1000);
}

TEST(PaintedCells, have_their_colors_and_large_ones_borders) {
    CellImage image{LEAST_BORDERED + 2, 1, std::vector<std::int32_t>(LEAST_BORDERED, 0), {}, {}};
    image.ids.insert(image.ids.end(), {1, -1});
    find_borders(image);
    const Image painted = paint_cells(image, std::vector<glm::vec3>{{1, 0, 0}, {0, 1, 0}});
    const auto pixel = [&](std::size_t at) { return std::vector(&painted.rgb[3 * at], &painted.rgb[3 * at] + 3); };
    EXPECT_EQ(pixel(LEAST_BORDERED - 2), (std::vector<float>{1, 0, 0}));
    EXPECT_EQ(pixel(LEAST_BORDERED - 1), (std::vector<float>{0, 0, 0})) << "its border";
    EXPECT_EQ(pixel(LEAST_BORDERED), (std::vector<float>{0, 1, 0})) << "too small for a border";
    EXPECT_EQ(pixel(LEAST_BORDERED + 1), (std::vector<float>{0, 0, 0})) << "no cell";
}

} // namespace
} // namespace photonloupe::test
