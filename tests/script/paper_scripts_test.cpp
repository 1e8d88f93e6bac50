// SPDX-License-Identifier: Apache-2.0
// Whole scripts over paths made by hand, against closed forms in double precision: tortuosity, principal components of
// a path [SJL15], clusters, histograms, the brightest photon, axes of all photons.
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "script/interpret.h"

namespace photonloupe::script::tests {
namespace {

using Point = std::array<double, 3>;
struct Path {
    std::vector<Point> vertices, normals;
};

Point scale(const Point& a, double s) {
    return {a[0] * s, a[1] * s, a[2] * s};
}
Point subtract(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point normalize(const Point& a) {
    return scale(a, 1 / std::sqrt(dot(a, a)));
}

HostPhotons make_path_photons(const std::vector<Path>& paths) {
    HostPhotons photons = make_photons(std::uint32_t(paths.size()), 0);
    for (std::size_t i = 0; i < paths.size(); ++i) {
        for (std::size_t j = 0; j < paths[i].vertices.size(); ++j) {
            for (int axis = 0; axis < 3; ++axis) {
                photons.path_vertices.push_back(float(paths[i].vertices[j][std::size_t(axis)]));
                photons.path_normals.push_back(float(paths[i].normals[j][std::size_t(axis)]));
            }
            photons.path_interactions.push_back(1);
            photons.path_objects.push_back(0);
            photons.path_scatter.push_back(1);
        }
        photons.path_starts[i + 1] = photons.path_starts[i] + std::int64_t(paths[i].vertices.size());
    }
    return photons;
}

std::vector<Path> make_random_paths(std::uint32_t count) {
    std::mt19937 engine(11);
    std::normal_distribution<double> spread(0, 1);
    std::vector<Path> paths(count);
    for (Path& path : paths)
        for (std::uint32_t j = engine() % 7; j > 0; --j) {
            path.vertices.push_back({spread(engine), spread(engine), spread(engine)});
            path.normals.push_back(normalize({spread(engine), spread(engine), spread(engine)}));
        }
    return paths;
}

// [SJL15] eq. 1
double compute_tortuosity(const Path& path) {
    const std::size_t m = path.vertices.size();
    double sum = 0;
    for (std::size_t j = 1; j + 1 < m; ++j) {
        const Point a = normalize(subtract(path.vertices[j], path.vertices[j - 1]));
        const Point b = normalize(subtract(path.vertices[j + 1], path.vertices[j]));
        sum += std::acos(std::clamp(dot(a, b), -1.0, 1.0));
    }
    return sum / (std::numbers::pi * double(m - 2));
}

// [SJL15] section 5.3: first eigenvector times the root of its eigenvalue, of the planar forms of the primal direction
// and the path's normals (whose azimuths are doubled); METHODS section 4 chooses the sign.
std::array<double, 2> compute_path_component(const Path& path) {
    std::vector<std::array<double, 2>> points;
    const auto push = [&](const Point& t, double turns) {
        const double theta = std::acos(t[2]), phi = turns * std::atan2(t[0], t[1]);
        points.push_back({theta * std::sin(phi), theta * std::cos(phi)});
    };
    push(normalize(subtract(path.vertices[1], path.vertices[0])), 1);
    for (std::size_t j = 1; j < path.normals.size(); ++j)
        push(path.normals[j], 2);
    double mean[2] = {}, xx = 0, xy = 0, yy = 0;
    for (const auto& p : points)
        for (int k = 0; k < 2; ++k)
            mean[k] += p[std::size_t(k)] / double(points.size());
    for (const auto& p : points) {
        const double x = p[0] - mean[0], y = p[1] - mean[1];
        xx += x * x / double(points.size());
        xy += x * y / double(points.size());
        yy += y * y / double(points.size());
    }
    const double value = (xx + yy) / 2 + std::sqrt((xx - yy) * (xx - yy) / 4 + xy * xy);
    const double angle = std::atan2(2 * xy, xx - yy) / 2;
    double u = std::cos(angle), v = std::sin(angle);
    if (u * points[0][0] + v * points[0][1] < 0) {
        u = -u;
        v = -v;
    }
    return {u * std::sqrt(value), v * std::sqrt(value)};
}

constexpr const char* TORTUOSITY = R"(
    declarePhotonParameter(3, 0, 1, "bend");
    for (p = 0; p < getNumPhotons(); p++) {
        m = getNumPathVertices(p);
        if (m < 3) continue;
        bend = 0;
        for (k = 1; k + 1 < m; k++) {
            float a[3]; float b[3];
            for (c = 0; c < 3; c++) {
                a[c] = getPathVertex(p, k, c) - getPathVertex(p, k - 1, c);
                b[c] = getPathVertex(p, k + 1, c) - getPathVertex(p, k, c);
            }
            bend += acos(dot(a[0], a[1], a[2], b[0], b[1], b[2]) /
                         (magnitude(a[0], a[1], a[2]) * magnitude(b[0], b[1], b[2])));
        }
        setPhotonParameter(p, 3, bend / (Pi * (m - 2)));
    }
)";

constexpr const char* COMPONENT = R"(
    declarePhotonParameter(3, -PI, PI); declarePhotonParameter(4, -PI, PI);
    function push(x, y, z, turns) {
        theta = acos(z); phi = turns * atan2(x, y);
        pushPCA2D(theta * sin(phi), theta * cos(phi));
    }
    for (p = 0; p < getNumPhotons(); p++) {
        if (getNumVertices(p) < 2) continue;
        resetPCA2D();
        dx = getPathVertex(p, 1, X) - getPathVertex(p, 0, X);
        dy = getPathVertex(p, 1, Y) - getPathVertex(p, 0, Y);
        dz = getPathVertex(p, 1, Z) - getPathVertex(p, 0, Z);
        l = magnitude(dx, dy, dz);
        push(dx / l, dy / l, dz / l, 1);
        for (k = 1; k < getNumVertices(p); k++)
            push(getPathNormal(p, k, X), getPathNormal(p, k, Y), getPathNormal(p, k, Z), 2);
        if (!decomposePCA2D()) continue;
        for (c = 0; c < 2; c++)
            setPhotonParameter(p, 3 + c, getPCAEigenvector(0, c) * sqrt(getPCAEigenvalue(0)));
    }
)";

void expect_tortuosity(const std::string& text) {
    std::vector<Path> paths = make_random_paths(300);
    paths[0].vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}};          // two right angles: 1/2
    paths[1].vertices = {{0, 0, 0}, {.1, .1, .1}, {.2, .2, .2}, {.3, .3, .3}}; // straight, but for rounding
    paths[0].normals = paths[1].normals = std::vector<Point>(4, {0, 1, 0});
    Ran ran = interpret(text, make_path_photons(paths));
    ASSERT_EQ(ran.errors, "");
    EXPECT_NEAR(ran.outputs.columns.read_parameter(0, 0), 0.5, 1e-6);
    EXPECT_NEAR(ran.outputs.columns.read_parameter(0, 1), 0.0, 1e-3);
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const float found = ran.outputs.columns.read_parameter(0, i);
        if (paths[i].vertices.size() < 3)
            EXPECT_TRUE(is_unset(found));
        else
            EXPECT_NEAR(found, compute_tortuosity(paths[i]), i == 1 ? 1e-3 : 1e-5);
    }
    EXPECT_TRUE(ran.outputs.faults.empty());
}

void expect_components(const std::string& text) {
    const std::vector<Path> paths = make_random_paths(300);
    Ran ran = interpret(text, make_path_photons(paths));
    ASSERT_EQ(ran.errors, "");
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const float u = ran.outputs.columns.read_parameter(0, i), v = ran.outputs.columns.read_parameter(1, i);
        if (paths[i].vertices.size() < 2) {
            EXPECT_TRUE(is_unset(u) && is_unset(v));
            continue;
        }
        const auto [exact_u, exact_v] = compute_path_component(paths[i]);
        EXPECT_NEAR(u, exact_u, 2e-4) << i;
        EXPECT_NEAR(v, exact_v, 2e-4) << i;
    }
}

std::string read_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(PaperScripts, tortuosity_is_that_of_equation_1) {
    expect_tortuosity(TORTUOSITY);
}

TEST(PaperScripts, components_of_paths_are_those_of_section_5_3) {
    expect_components(COMPONENT);
}

TEST(PaperScripts, written_as_the_paper_writes_they_give_the_same) {
    const std::string folder = PHOTONLOUPE_SOURCE_DIR "/tests/script/paper/";
    expect_tortuosity(read_file(folder + "tortuosity.photon"));
    expect_components(read_file(folder + "components.photon"));
}

} // namespace
} // namespace photonloupe::script::tests
