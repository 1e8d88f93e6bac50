// SPDX-License-Identifier: Apache-2.0
// The meaning of statements, operators and faults, by small scripts with known results.
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "script/interpret.h"

namespace photonloupe::script::tests {
namespace {

TEST(Interpreter, division_is_real_and_remainders_truncate) {
    const Ran ran = interpret("a = 1 / 2; b = -7 % 3; c = 7.5 % 2; d = 5 / 0.0; z = 0; e = 3 % z;");
    EXPECT_EQ(ran.real("a"), 0.5f);
    EXPECT_EQ(ran.integer("b"), -1);
    EXPECT_EQ(ran.real("c"), 1.5f);
    EXPECT_TRUE(std::isinf(ran.real("d")));
    EXPECT_EQ(ran.integer("e"), 0);
    ASSERT_TRUE(ran.find_fault(Fault::modulo_by_zero));
}

TEST(Interpreter, integers_wrap) {
    const Ran ran = interpret("n = 2147483647; n += 1; m = n * 3; k = -n;");
    EXPECT_EQ(ran.integer("n"), INT32_MIN);
    EXPECT_EQ(ran.integer("m"), INT32_MIN);
    EXPECT_EQ(ran.integer("k"), INT32_MIN);
}

TEST(Interpreter, comparisons_and_logic_give_whole_truths_and_stop_early) {
    const Ran ran =
        interpret("n = 0; a = (2 > 1) + (1 == 1); b = 0 && n++; c = 1 || n++; d = !3; e = (0.0/0.0) ? 1 : 2;");
    EXPECT_EQ(ran.integer("a"), 2);
    EXPECT_EQ(ran.integer("b"), 0);
    EXPECT_EQ(ran.integer("c"), 1);
    EXPECT_EQ(ran.integer("d"), 0);
    EXPECT_EQ(ran.integer("n"), 0);
    EXPECT_EQ(ran.integer("e"), 1);
}

TEST(Interpreter, assignments_are_expressions) {
    const Ran ran = interpret("a = b = 3; i = 4; c = i++ + ++i; d = (a += 2) * 10;");
    EXPECT_EQ(ran.integer("a"), 5);
    EXPECT_EQ(ran.integer("b"), 3);
    EXPECT_EQ(ran.integer("c"), 10);
    EXPECT_EQ(ran.integer("d"), 50);
}

TEST(Interpreter, loops_break_and_continue) {
    const Ran ran = interpret(R"(
        s = 0; for (i = 0; i < 10; i++) { if (i == 3) continue; if (i == 6) break; s += i; }
        n = 0; do { n++; } while (n < 5);
        w = 10; while (w > 2) w -= 3;
    )");
    EXPECT_EQ(ran.integer("s"), 0 + 1 + 2 + 4 + 5);
    EXPECT_EQ(ran.integer("n"), 5);
    EXPECT_EQ(ran.integer("w"), 1);
}

TEST(Interpreter, functions_have_variables_of_their_own) {
    const Ran ran = interpret(R"(
        t = 7;
        float twice(x) { y = 2 * x; return y; }
        function add(a, b) { return a + b + t; }
        r = add(twice(1.5), twice(2));
    )");
    EXPECT_EQ(ran.real("r"), 3.0f + 4.0f + 7.0f);
}

TEST(Interpreter, a_function_that_ends_without_a_value_gives_nan) {
    const Ran ran = interpret("float f(x) { if (x > 0) return 1.5; } a = f(1); b = f(-1);");
    EXPECT_EQ(ran.real("a"), 1.5f);
    EXPECT_TRUE(std::isnan(ran.real("b")));
    EXPECT_TRUE(ran.find_fault(Fault::no_value));
}

TEST(Interpreter, arrays_are_zeroed_whenever_their_declaration_runs) {
    const Ran ran = interpret("s = 0; for (i = 0; i < 3; i++) { float c[2]; c[1] += 1; s += c[0] + c[1]; }");
    EXPECT_EQ(ran.real("s"), 3.0f);
}

TEST(Interpreter, what_is_outside_an_array_is_nan_and_writes_are_dropped) {
    const Ran ran = interpret(
        "float c[3]; i = getNumPhotons(); c[i] = 1; a = c[i]; h = i * 0.0625; b = c[h]; c[1.0 * 2] = 4; d = c[2];");
    EXPECT_TRUE(std::isnan(ran.real("a")));
    EXPECT_TRUE(std::isnan(ran.real("b")));
    EXPECT_EQ(ran.real("d"), 4.0f);
    EXPECT_TRUE(ran.find_fault(Fault::array_index));
    EXPECT_TRUE(ran.find_fault(Fault::not_integral));
}

TEST(Interpreter, a_variable_that_may_be_unset_is_nan_and_reported) {
    const Ran ran = interpret("n = getNumPhotons(); if (n > 100) v = 1.5; w = v + 1;");
    EXPECT_TRUE(std::isnan(ran.real("w")));
    ASSERT_TRUE(ran.find_fault(Fault::unset_variable));
    EXPECT_EQ(ran.find_fault(Fault::unset_variable)->first_photon, NO_PHOTON);
}

TEST(Interpreter, predefined_names_hold_their_values_until_assigned) {
    const Ran ran = interpret("a = X + 10 * Y + 100 * Z; b = E; X = 5; c = X; d = Pi == PI && true && !false;");
    EXPECT_EQ(ran.real("a"), 210.0f);
    EXPECT_NEAR(ran.real("b"), 2.718282f, 1e-6f);
    EXPECT_EQ(ran.real("c"), 5.0f);
    EXPECT_EQ(ran.integer("d"), 1);
}

TEST(Interpreter, an_endless_loop_of_uniform_code_ends_with_the_fuel) {
    RunSettings settings;
    settings.fuel = 1000;
    const Ran ran = interpret("a = 1;\nwhile (true) a = 2;\na = 3;", make_photons(1), settings);
    EXPECT_EQ(ran.integer("a"), 2);
    EXPECT_NE(ran.outputs.stopped.find("line 2"), std::string::npos);
    EXPECT_NE(ran.outputs.stopped.find("1000"), std::string::npos);
}

TEST(Interpreter, exposed_variables_take_the_value_they_are_given) {
    RunSettings settings;
    settings.values["alpha"] = 70;
    const std::string text = "alpha = 50; expose alpha range 1, 1000\nb = 2 * alpha;";
    EXPECT_EQ(interpret(text, make_photons(1)).real("b"), 100.0f);
    EXPECT_EQ(interpret(text, make_photons(1), settings).real("b"), 140.0f);
    settings.values["alpha"] = 1001;
    EXPECT_THROW(interpret(text, make_photons(1), settings), Error);
    settings.values["alpha"] = std::nan("");
    EXPECT_THROW(interpret(text, make_photons(1), settings), Error);
    settings.values = {{"beta", 1.0}};
    EXPECT_THROW(interpret(text, make_photons(1), settings), Error);
}

} // namespace
} // namespace photonloupe::script::tests
