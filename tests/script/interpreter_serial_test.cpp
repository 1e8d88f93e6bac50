// SPDX-License-Identifier: Apache-2.0
// Loops over photons that run one after another: left early, jumping, out of fuel or time, stopped from outside.
#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "script/interpret.h"

namespace photonloupe::script::tests {
namespace {

TEST(InterpreterSerial, a_loop_that_is_left_keeps_its_variable) {
    const Ran ran = interpret("s = 0; for (i = 0; i < getNumPhotons(); i++) { if (i == 3) break; s = s * 2 + i; }");
    EXPECT_EQ(ran.integer("i"), 3);
    EXPECT_EQ(ran.integer("s"), (0 * 2 + 1) * 2 + 2);
}

TEST(InterpreterSerial, a_loop_that_ends_holds_the_count) {
    EXPECT_EQ(interpret("for (i = 0; i < getNumPhotons(); i++) ;").integer("i"), 8);
    EXPECT_EQ(interpret("for (i = 0; i < getNumPhotons(); i++) ;", make_photons(0)).integer("i"), 0);
}

TEST(InterpreterSerial, a_function_returns_out_of_its_loop) {
    const Ran ran = interpret(R"(
        found = find(20); missing = find(1000);
        function find(y) {
            for (p = 0; p < getNumPhotons(); p++)
                if (getPhotonPosition(p, Y) >= y) return p;
            return -1;
        }
    )");
    EXPECT_EQ(ran.integer("found"), 2);
    EXPECT_EQ(ran.integer("missing"), -1);
}

TEST(InterpreterSerial, a_body_that_assigns_the_variable_decides_what_comes_next) {
    const Ran ran = interpret(R"(
        n = 0; s = 0; back = 0;
        for (i = 0; i < getNumPhotons(); i++) {
            n++;
            s += getPhotonPosition(i, X);
            if (i == 5 && back < 2) { back = back + 1; i = 2; }
            if (i % 2 == 0) i += 1;
        }
    )");
    // Only 0, 2, 4 and 6 begin a turn.
    EXPECT_EQ(ran.integer("n"), 4);
    EXPECT_EQ(ran.real("s"), 12.0f);
    EXPECT_EQ(ran.integer("i"), 8);
}

TEST(InterpreterSerial, a_body_that_jumps_back_meets_photons_again) {
    const Ran ran = interpret(R"(
        n = 0; back = 0;
        for (i = 0; i < getNumPhotons(); i++) {
            n++;
            if (i == 5 && back < 2) { back = back + 1; i = 2; }
        }
    )");
    EXPECT_EQ(ran.integer("n"), 8 + 3 + 3);
}

TEST(InterpreterSerial, photons_below_the_first_do_not_exist) {
    const Ran ran = interpret(R"(
        t = 0; bad = 0;
        for (i = 0; i < getNumPhotons(); i++) {
            if (t == 0) { t = 1; i = -3; }
            x = getPhotonPosition(i, X);
            if (!(x == x)) bad = bad + 1;
        }
    )");
    EXPECT_EQ(ran.integer("bad"), 3); // -3, -2, -1
    ASSERT_TRUE(ran.find_fault(Fault::photon_index));
}

TEST(InterpreterSerial, a_loop_out_of_time_stops_in_the_middle_of_a_photon) {
    RunSettings settings;
    settings.most_seconds = 0.05;
    settings.fuel = 4'000'000'000u;
    const auto start = std::chrono::steady_clock::now();
    Ran ran = interpret("declarePhotonParameter(3, 0, 1); n = 0; for (i = 0; i < getNumPhotons(); i++) "
                        "{ n++; setPhotonParameter(i, 3, 1); while (i == 2) ; }",
                        make_photons(5), settings);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 20.0);
    EXPECT_NE(ran.outputs.loops.at(0).stopped, "");
    EXPECT_EQ(ran.integer("n"), 2);
    EXPECT_EQ(ran.outputs.columns.read_parameter(0, 1), 1.0f);
    EXPECT_TRUE(is_unset(ran.outputs.columns.read_parameter(0, 2)));
    EXPECT_TRUE(is_unset(ran.outputs.columns.read_parameter(0, 3)));
}

TEST(InterpreterSerial, bounded_loops_are_stopped_from_outside_too) {
    int calls = 0;
    const Progress impatient{[&](std::string_view, double) { return ++calls < 3; }};
    EXPECT_THROW(interpret("for (i = 0; i < getNumPhotons(); i++) for (j = 0; j < 900000; j++) ;", make_photons(4000),
                           {}, impatient),
                 Cancelled);
    EXPECT_EQ(calls, 3);
    calls = 0;
    EXPECT_THROW(interpret("for (j = 0; j < 900000; j++) x = j;", make_photons(1), {}, impatient), Cancelled);
}

TEST(InterpreterSerial, fuel_is_a_turn_of_a_loop_without_bound) {
    RunSettings settings;
    settings.fuel = 10;
    const std::string body = "{ j = 0; while (j < i) j++; for (k = 0; k < 100; k++) ; done++; }";
    const Ran ran = interpret("done = 0; for (i = 0; i < getNumPhotons(); i++) " + body, make_photons(20), settings);
    EXPECT_EQ(ran.integer("done"), 11); // 0 … 10 turns
    EXPECT_EQ(ran.outputs.loops.at(0).exhausted, 9u);
    EXPECT_EQ(ran.outputs.loops.at(0).first_exhausted, 11u);
}

TEST(InterpreterSerial, a_photon_out_of_fuel_takes_back_extremes_choices_and_points) {
    RunSettings settings;
    settings.fuel = 10;
    const Ran ran = interpret(R"(
        low = 1e9; best = -1.0; who = -1; float a[2]; int hits[2];
        for (i = 0; i < getNumPhotons(); i++) {
            v = getPhotonPosition(i, X);
            low = min(low, -v);
            if (v > best) { best = v; who = i; }
            a[i % 2] += v; hits[i % 2]++;
            pushPCA2D(v, 0);
            histogram("v", v, 0, 100);
            print("v", v);
            j = 0; while (i >= 6) j++;
        }
        ok = decomposePCA2D(); mean = getPCAMean(0);
    )",
                              make_photons(8), settings);
    EXPECT_EQ(ran.real("low"), -5.0f);
    EXPECT_EQ(ran.real("best"), 5.0f);
    EXPECT_EQ(ran.integer("who"), 5);
    EXPECT_EQ(ran.real("a", 0), 0.0f + 2 + 4);
    EXPECT_EQ(ran.integer("hits", 1), 3);
    EXPECT_EQ(ran.real("mean"), 2.5f);
    EXPECT_EQ(ran.outputs.prints.size(), 6u);
    std::uint32_t counted = 0;
    for (const std::uint32_t count : ran.outputs.histograms.at(0).counts)
        counted += count;
    EXPECT_EQ(counted, 6u);
}

} // namespace
} // namespace photonloupe::script::tests
