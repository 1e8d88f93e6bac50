// SPDX-License-Identifier: Apache-2.0
// Scripts that must run in parallel by the rules, interpreted over photons made by hand: clusters, histograms into
// arrays, the brightest photon, axes of all photons.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "script/interpret.h"
#include "script/script_files.h"

namespace photonloupe::script::tests {
namespace {

std::string read_accepted(const std::string& name) {
    return test::read_script(std::filesystem::path(PHOTONLOUPE_SOURCE_DIR) / "tests/script/accept" / name).text;
}

TEST(WholeScripts, the_brightest_photon_is_found) {
    HostPhotons photons = make_photons(1000);
    photons.power[3 * 637 + 1] = 50;
    photons.power[3 * 12 + 2] = -7;
    const Ran ran = interpret(read_accepted("brightest_photon.photon"), photons);
    EXPECT_EQ(ran.integer("where"), 637);
    EXPECT_EQ(ran.real("most"), 54.0f);
    EXPECT_EQ(ran.real("least"), 1.0f + 2.0f - 7.0f);
    EXPECT_EQ(ran.outputs.prints.at(0), "brightest 637 54 -4");
}

TEST(WholeScripts, a_histogram_is_counted_into_an_array) {
    HostPhotons photons = make_photons(6400);
    for (std::size_t i = 0; i < photons.count; ++i)
        photons.power[3 * i] = float(i % 64) / 64 + (i % 64 == 20 && i > 6000 ? 1 : 0);
    const Ran ran = interpret(read_accepted("histogram_into_array.photon"), photons);
    EXPECT_EQ(ran.integer("bins", 0), 100);
    EXPECT_EQ(ran.integer("bins", 20), 94);
    EXPECT_EQ(ran.integer("bins", 63), 106);
    EXPECT_EQ(ran.integer("fullest"), 63);
    const HistogramCounts& histogram = ran.outputs.histograms.at(0);
    EXPECT_EQ(histogram.counts.size(), 32u);
    EXPECT_EQ(histogram.above, 6u);
}

TEST(WholeScripts, axes_of_all_photons_are_those_of_double_precision) {
    HostPhotons photons = make_photons(5000);
    std::mt19937 engine(4);
    std::normal_distribution<float> spread(0, 1);
    double mean[3] = {};
    for (std::size_t i = 0; i < photons.count; ++i) {
        const float along = 5 * spread(engine);
        const float point[3] = {100 + along * 0.6f + 0.01f * spread(engine), along * 0.8f + 0.01f * spread(engine),
                                -3 + 0.01f * spread(engine)};
        std::copy(point, point + 3, photons.positions.begin() + std::ptrdiff_t(3 * i));
        for (int axis = 0; axis < 3; ++axis)
            mean[axis] += double(point[axis]) / photons.count;
    }
    Ran ran = interpret(read_accepted("global_principal_axes.photon"), photons);
    const double sign = ran.real("ux") < 0 ? -1 : 1;
    EXPECT_NEAR(sign * ran.real("ux"), 0.6, 1e-3);
    EXPECT_NEAR(sign * ran.real("uy"), 0.8, 1e-3);
    EXPECT_NEAR(ran.real("uz"), 0, 1e-3);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(ran.state.decomposition.mean[axis], mean[axis], 1e-4);
    double sum = 0;
    for (std::size_t i = 0; i < photons.count; ++i)
        sum += double(ran.outputs.columns.read_parameter(0, i)) / photons.count;
    EXPECT_NEAR(sum, 0, 1e-3);
}

TEST(WholeScripts, directions_gather_in_clusters) {
    HostPhotons photons = make_photons(4000, 2);
    std::mt19937 engine(9);
    std::normal_distribution<float> spread(0, 0.02f);
    constexpr float CENTERS[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-0.6f, -0.8f, 0}};
    for (std::size_t i = 0; i < photons.count; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            photons.path_vertices[6 * i + axis] = 0;
            photons.path_vertices[6 * i + 3 + axis] = CENTERS[i % 4][axis] + spread(engine);
        }
    Ran ran = interpret(read_accepted("kmeans_of_directions.photon"), photons);
    std::int32_t counted = 0;
    for (std::size_t c = 0; c < 4; ++c)
        counted += ran.integer("count", c);
    EXPECT_EQ(counted, 4000);
    EXPECT_LE(ran.real("moved"), 0.001f);
    for (std::size_t i = 4; i < photons.count; ++i) // photons of one direction are in one cluster
        EXPECT_EQ(ran.outputs.columns.read_parameter(0, i), ran.outputs.columns.read_parameter(0, i % 4)) << i;
}

TEST(WholeScripts, signatures_are_exact_to_fifteen_interactions) {
    HostPhotons photons = make_photons(2, 17);
    std::int64_t expected = 0;
    for (int j = 1; j <= 15; ++j) {
        photons.path_interactions[std::size_t(17 + j)] = j % 3 == 0 ? 1 : 2;
        expected += std::int64_t(std::pow(3, j - 1)) * (j % 3 == 0 ? 1 : 2);
    }
    Ran ran = interpret(read_accepted("signature.photon"), photons);
    EXPECT_EQ(ran.outputs.columns.read_parameter(0, 1), float(expected));
    EXPECT_EQ(double(ran.outputs.columns.read_parameter(0, 1)), double(expected));
}

} // namespace
} // namespace photonloupe::script::tests
