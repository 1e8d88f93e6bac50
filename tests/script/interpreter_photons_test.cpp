// SPDX-License-Identifier: Apache-2.0
// Photon loops in the interpreter: columns, reductions, fuel, reports.
#include <cmath>

#include <gtest/gtest.h>

#include "script/interpret.h"

namespace photonloupe::script::tests {
namespace {

constexpr const char* EACH = "for (i = 0; i < getNumPhotons(); i++) ";

std::string each(const std::string& body) {
    return EACH + std::string("{ ") + body + " }";
}

TEST(InterpreterPhotons, columns_and_paths_are_read) {
    const Ran ran = interpret(R"(
        p = getPhotonPosition(2, Z); n = getPhotonNormal(2, Y); w = getPhotonPower(2, 1); e = getPhotonEmitter(3);
        v = getNumPathVertices(2); x = getPathVertex(2, 1, Y); m = getPathNormal(2, 1, Y);
        k = getPathInteraction(2, 1); o = getPathObject(2, 0); s = getPathScatter(2, 1); u = getNumVertices(2);
    )");
    EXPECT_EQ(ran.real("p"), 200.0f);
    EXPECT_EQ(ran.real("n"), 1.0f);
    EXPECT_EQ(ran.real("w"), 2.0f);
    EXPECT_EQ(ran.integer("e"), 1);
    EXPECT_EQ(ran.integer("v"), 3);
    EXPECT_EQ(ran.integer("u"), 3);
    EXPECT_EQ(ran.real("x"), 1.0f);
    EXPECT_EQ(ran.real("m"), 1.0f);
    EXPECT_EQ(ran.integer("k"), 1);
    EXPECT_EQ(ran.integer("o"), -1);
    EXPECT_EQ(ran.real("s"), 0.5f);
}

TEST(InterpreterPhotons, parameters_and_colors_are_set_and_what_is_not_stays_unset) {
    Ran ran = interpret(
        "GAMMA = 3; declarePhotonParameter(GAMMA, 0, 10);" +
        each("if (i % 2 == 0) continue; setPhotonParameter(i, GAMMA, i); setPhotonColourEncoding(i, 1, 0.5, i);"));
    ScriptColumns& columns = ran.outputs.columns;
    ASSERT_EQ(columns.declared().size(), 1u);
    EXPECT_EQ(columns.declared()[0].name, "GAMMA");
    EXPECT_EQ(columns.read_parameter(0, 5), 5.0f);
    EXPECT_TRUE(is_unset(columns.read_parameter(0, 4)));
    EXPECT_EQ(columns.host_colors()[3 * 5 + 2], 5.0f);
    EXPECT_TRUE(is_unset(columns.host_colors()[3 * 4]));
}

TEST(InterpreterPhotons, a_parameter_set_in_one_loop_is_read_in_the_next) {
    const Ran ran = interpret("declarePhotonParameter(3, 0, 100);" + each("setPhotonParameter(i, 3, i * i);") +
                              "s = 0;" + each("s += getPhotonParameter(i, 3);"));
    EXPECT_EQ(ran.real("s"), 0 + 1 + 4 + 9 + 16 + 25 + 36 + 49);
}

TEST(InterpreterPhotons, sums_counts_extremes_and_choices_are_reduced) {
    const Ran ran = interpret(R"(
        s = 100; n = 0; lo = 1000.0; hi = -1.0; best = 1e9; who = -1;
        for (i = 0; i < getNumPhotons(); i++) {
            d = abs(getPhotonPosition(i, X) - 4.25);
            s += getPhotonPosition(i, Y); n++; lo = min(lo, d); hi = max(d, hi);
            if (d < best) { best = d; who = i; }
        }
    )");
    EXPECT_EQ(ran.real("s"), 100.0f + 280.0f);
    EXPECT_EQ(ran.integer("n"), 8);
    EXPECT_EQ(ran.real("lo"), 0.25f);
    EXPECT_EQ(ran.real("hi"), 4.25f);
    EXPECT_EQ(ran.real("best"), 0.25f);
    EXPECT_EQ(ran.integer("who"), 4);
}

TEST(InterpreterPhotons, ties_of_a_choice_go_to_the_lowest_photon) {
    const Ran ran = interpret("best = 1e9; who = -1;" +
                                  each("if (getPhotonPower(i, 0) < best) { best = getPhotonPower(i, 0); who = i; }"),
                              make_photons(10'000));
    EXPECT_EQ(ran.integer("who"), 0);
}

TEST(InterpreterPhotons, float_sums_are_taken_in_blocks_and_lanes) {
    const std::uint32_t count = 10'000;
    const Ran ran = interpret("s = 0.5;" + each("s += 1.0 / (i + 1);"), make_photons(count));
    std::vector<float> blocks;
    for (std::uint32_t first = 0; first < count; first += 4096) {
        std::vector<float> lanes(64);
        for (std::uint32_t i = first; i < std::min(first + 4096, count); ++i)
            lanes[i % 64] += 1.0f / static_cast<float>(i + 1);
        for (std::size_t width = 32; width > 0; width /= 2)
            for (std::size_t i = 0; i < width; ++i)
                lanes[i] = lanes[2 * i] + lanes[2 * i + 1];
        blocks.push_back(lanes[0]);
    }
    ASSERT_EQ(blocks.size(), 3u);
    EXPECT_EQ(ran.real("s"), 0.5f + ((blocks[0] + blocks[1]) + blocks[2]));
}

TEST(InterpreterPhotons, arrays_are_reduced_by_element) {
    const Ran ran = interpret("int c[4]; float low[4]; for (k = 0; k < 4; k++) low[k] = 1000;" +
                                  each("c[i % 4]++; low[i % 4] = min(low[i % 4], getPhotonPosition(i, Y));"),
                              make_photons(10));
    EXPECT_EQ(ran.integer("c", 0), 3);
    EXPECT_EQ(ran.integer("c", 3), 2);
    EXPECT_EQ(ran.real("low", 3), 30.0f);
}

TEST(InterpreterPhotons, a_serial_loop_means_what_one_processor_does) {
    const Ran ran = interpret("last = 0; s = 0;" + each("s = s * 0.5 + i; last = i;"));
    float expected = 0;
    for (int i = 0; i < 8; ++i)
        expected = expected * 0.5f + static_cast<float>(i);
    EXPECT_EQ(ran.real("s"), expected);
    EXPECT_EQ(ran.integer("last"), 7);
}

TEST(InterpreterPhotons, a_photon_out_of_fuel_leaves_nothing_and_takes_no_part) {
    RunSettings settings;
    settings.fuel = 100;
    Ran ran = interpret("declarePhotonParameter(3, 0, 10); n = 0; float c[2];" +
                            each("n++; c[1] += 1; setPhotonParameter(i, 3, i); j = 0; while (i == 5 || j < 10) j++;"),
                        make_photons(8), settings);
    EXPECT_EQ(ran.integer("n"), 7);
    EXPECT_EQ(ran.real("c", 1), 7.0f);
    EXPECT_TRUE(is_unset(ran.outputs.columns.read_parameter(0, 5)));
    EXPECT_EQ(ran.outputs.columns.read_parameter(0, 6), 6.0f);
    ASSERT_EQ(ran.outputs.loops.size(), 1u);
    EXPECT_EQ(ran.outputs.loops[0].exhausted, 1u);
    EXPECT_EQ(ran.outputs.loops[0].first_exhausted, 5u);
}

TEST(InterpreterPhotons, a_loop_stops_when_too_many_photons_run_out) {
    RunSettings settings;
    settings.fuel = 10;
    settings.most_exhausted = 20;
    const Ran ran = interpret(each("while (true) ;"), make_photons(1000), settings);
    EXPECT_EQ(ran.outputs.loops[0].exhausted, 20u);
    EXPECT_FALSE(ran.outputs.loops[0].stopped.empty());
}

TEST(InterpreterPhotons, faults_count_photons_once_and_name_the_first) {
    const Ran ran =
        interpret(each("for (j = 0; j < 3; j++) v = getPathVertex(i, 3 + (i < 4 ? 0 : -1), X);"), make_photons(8));
    const FaultReport* fault = ran.find_fault(Fault::vertex_index);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->count, 4u);
    EXPECT_EQ(fault->first_photon, 0u);
}

TEST(InterpreterPhotons, histograms_count_what_is_outside_apart) {
    const Ran ran = interpret(each("histogram(\"h\", i == 7 ? 0.0 / 0.0 : i - 1.0, 0, 4, 4);"));
    ASSERT_EQ(ran.outputs.histograms.size(), 1u);
    const HistogramCounts& histogram = ran.outputs.histograms[0];
    EXPECT_EQ(histogram.counts, (std::vector<std::uint32_t>{1, 1, 1, 2})); // 0 1 2 and 3, 4
    EXPECT_EQ(histogram.below, 1u);
    EXPECT_EQ(histogram.above, 1u);
    EXPECT_EQ(histogram.non_finite, 1u);
}

TEST(InterpreterPhotons, the_first_twenty_lines_are_printed) {
    const Ran ran = interpret("print(\"start\", 1.5);" + each("print(\"value\", i, i * 0.5);"), make_photons(100));
    ASSERT_EQ(ran.outputs.prints.size(), 21u);
    EXPECT_EQ(ran.outputs.prints[0], "start 1.5");
    EXPECT_EQ(ran.outputs.prints[3], "photon 2: value 2 1");
}

TEST(InterpreterPhotons, neighbor_lists_are_read_by_index) {
    const Ran ran = interpret("s = 0;" + each("nn = getKNN(i, 3); for (j = 0; j < length(nn); j++) s += nn[j];"));
    EXPECT_EQ(ran.integer("s"), 3 * 28);
}

TEST(InterpreterPhotons, pca_of_a_line_lies_along_it_towards_the_first_point) {
    const Ran ran = interpret(R"(
        resetPCA2D(); pushPCA2D(-1, -2); pushPCA2D(1, 2); ok = decomposePCA2D();
        l = getPCAEigenvalue(0); u = getPCAEigenvector(0, X); v = getPCAEigenvector(0, Y); m = getPCAMean(0);
        resetPCA2D(); pushPCA2D(1, 1); none = decomposePCA2D();
    )");
    EXPECT_EQ(ran.integer("ok"), 1);
    EXPECT_NEAR(ran.real("l"), 5.0f, 1e-6f);
    EXPECT_NEAR(ran.real("u"), -1 / std::sqrt(5.0f), 1e-6f);
    EXPECT_NEAR(ran.real("v"), -2 / std::sqrt(5.0f), 1e-6f);
    EXPECT_EQ(ran.real("m"), 0.0f);
    EXPECT_EQ(ran.integer("none"), 0);
}

TEST(InterpreterPhotons, the_first_point_is_the_first_pushed_whoever_pushed_it) {
    const std::string axis = "decomposePCA2D(); u = getPCAEigenvector(0, X);";
    EXPECT_EQ(interpret(each("pushPCA2D(i + 1, 0);") + axis).real("u"), 1.0f);
    EXPECT_EQ(interpret("pushPCA2D(-3, 0);" + each("pushPCA2D(i + 1, 0);") + axis).real("u"), -1.0f);
    EXPECT_EQ(interpret(each("if (i == 5) pushPCA2D(-1, 0);") + each("pushPCA2D(i + 1, 0);") + axis).real("u"), -1.0f);
}

TEST(InterpreterPhotons, parameters_are_named_by_label_constant_or_number) {
    const auto name_all = [](const std::string& text) {
        std::string names;
        const Ran ran = interpret(text);
        for (const DeclaredParameter& parameter : ran.outputs.columns.declared())
            names += parameter.name + ' ';
        return names;
    };
    EXPECT_EQ(name_all("U = 3; declarePhotonParameter(U, 0, 1); declarePhotonParameter(4, 0, 1, \"angle\");"),
              "U angle ");
    EXPECT_EQ(name_all("for (d = 3; d < 6; d++) declarePhotonParameter(d, 0, 1);"), "p3 p4 p5 ");
    EXPECT_EQ(name_all("f(3); f(4); function f(d) { declarePhotonParameter(d, -1, 1); }"), "d p4 ");
    EXPECT_EQ(name_all("for (d = 3; d < 5; d++) declarePhotonParameter(d, 0, 1, \"same\");"), "same p4 ");
}

TEST(InterpreterPhotons, parameters_are_declared_in_any_order_but_without_gaps) {
    Ran ran = interpret("declarePhotonParameter(4, 0, 2); declarePhotonParameter(3, 0, 1);" +
                        each("setPhotonParameter(i, 4, i); setPhotonParameter(i, 3, -i);"));
    ASSERT_EQ(ran.outputs.columns.declared().size(), 2u);
    EXPECT_EQ(ran.outputs.columns.declared()[1].high, 2.0f);
    EXPECT_EQ(ran.outputs.columns.read_parameter(0, 3), -3.0f);
    EXPECT_EQ(ran.outputs.columns.read_parameter(1, 3), 3.0f);
    const Ran gap =
        interpret("n = getNumPhotons(); declarePhotonParameter(n - 5, 0, 1); declarePhotonParameter(n, 0, 1);");
    EXPECT_EQ(gap.outputs.columns.declared().size(), 1u);
    EXPECT_TRUE(gap.find_fault(Fault::declaration));
}

TEST(InterpreterPhotons, bounds_known_at_run_time_only_are_checked_there) {
    const Ran ran = interpret("n = getNumPhotons(); declarePhotonParameter(3, n, n);");
    EXPECT_EQ(ran.outputs.columns.declared().size(), 0u);
    EXPECT_TRUE(ran.find_fault(Fault::declaration));
}

TEST(InterpreterPhotons, a_list_that_may_be_unset_is_empty_and_reported) {
    const Ran ran =
        interpret("a = f(1); b = f(-1); function f(x) { if (x > 0) nn = getKNN(0, 3); return length(nn); }");
    EXPECT_EQ(ran.integer("a"), 3);
    EXPECT_EQ(ran.integer("b"), 0);
    EXPECT_TRUE(ran.find_fault(Fault::unset_variable));
}

TEST(InterpreterPhotons, reports_stay_small_whatever_a_script_does) {
    const Ran ran =
        interpret("for (j = 0; j < 20000; j++) { print(\"line\", j); histogram(\"h\", 0, 0, j + 1, 4096); }");
    EXPECT_EQ(ran.outputs.prints.size(), UNIFORM_PRINT_LIMIT);
    EXPECT_EQ(ran.outputs.histograms.size(), HISTOGRAM_LIMIT);
    EXPECT_TRUE(ran.find_fault(Fault::histogram_range));
    const Ran loop = interpret(each("for (j = 0; j < 100; j++) print(\"line\", j);"));
    EXPECT_EQ(loop.outputs.prints.size(), PRINT_LIMIT);
}

TEST(InterpreterPhotons, points_pushed_by_all_photons_are_one_set) {
    const Ran ran =
        interpret("resetPCA3D();" + each("pushPCA3D(i, 2 * i, 0);") +
                  "ok = decomposePCA3D(); l = getPCAEigenvalue(0); u = getPCAEigenvector(0, Y); m = getPCAMean(1);");
    EXPECT_EQ(ran.integer("ok"), 1);
    EXPECT_NEAR(ran.real("l"), 5 * 5.25f, 1e-4f); // variance of 0 … 7 is 5.25
    EXPECT_NEAR(std::abs(ran.real("u")), 2 / std::sqrt(5.0f), 1e-6f);
    EXPECT_NEAR(ran.real("m"), 7.0f, 1e-6f);
}

} // namespace
} // namespace photonloupe::script::tests
