// SPDX-License-Identifier: Apache-2.0
// Which variables are integers, and where conversions stand.
#include <gtest/gtest.h>

#include "script/builtins.h"
#include "script/script_files.h"

namespace photonloupe::test {
namespace {

using namespace script;

// "integer", "real" or "list" of the last variable of this name.
std::string find_type(const std::string& text, const std::string& name) {
    const Program program = check_accepted(text);
    std::string type = "none";
    for (const Variable& variable : program.variables)
        if (variable.name == name)
            type = variable.type == Type::integer ? "integer" : variable.type == Type::real ? "real" : "list";
    return type;
}

TEST(ScriptTypes, a_variable_is_an_integer_if_all_it_is_given_are) {
    EXPECT_EQ(find_type("x = 1; x = x + 2 * 3 - 4 % 5;", "x"), "integer");
    EXPECT_EQ(find_type("x = 1; x = 0.5;", "x"), "real");
    EXPECT_EQ(find_type("x = 1; x += 1.0;", "x"), "real");
    EXPECT_EQ(find_type("x = 1; x++; --x; x -= 3; x %= 2;", "x"), "integer");
    EXPECT_EQ(find_type("x = 0x10;", "x"), "integer");
}

TEST(ScriptTypes, division_is_real) {
    EXPECT_EQ(find_type("x = 4 / 2;", "x"), "real");
    EXPECT_EQ(find_type("x = 4; x /= 2;", "x"), "real");
    EXPECT_EQ(find_type("x = int(4 / 2);", "x"), "integer");
}

TEST(ScriptTypes, reals_spread_backwards_through_the_whole_script) {
    const std::string text = "a = 0; b = 0; c = 0; for (j = 0; j < 3; j++) { a = b; b = c; c = 0.5; }";
    EXPECT_EQ(find_type(text, "a"), "real");
    EXPECT_EQ(find_type(text, "j"), "integer");
}

TEST(ScriptTypes, comparisons_and_logic_are_integers) {
    EXPECT_EQ(find_type("x = 0.5 < 1.5;", "x"), "integer");
    EXPECT_EQ(find_type("x = 0.5 && 2.5 || !0.5;", "x"), "integer");
    EXPECT_EQ(find_type("x = true; y = x ? 1 : 0.5;", "y"), "real");
}

TEST(ScriptTypes, calls_keep_integers_where_they_can) {
    EXPECT_EQ(find_type("x = min(1, 2) + max(1, 2) + abs(-3) + clamp(1, 2, 3) + sign(-2) + mod(7, 3);", "x"),
              "integer");
    EXPECT_EQ(find_type("x = min(1, 2.0);", "x"), "real");
    EXPECT_EQ(find_type("x = floor(0.5) + ceil(0.5) + round(0.5) + int(0.5);", "x"), "integer");
    EXPECT_EQ(find_type("x = sqrt(4);", "x"), "real");
    EXPECT_EQ(find_type("x = getPathInteraction(0, 1);", "x"), "integer");
    EXPECT_EQ(find_type("x = getPathScatter(0, 1);", "x"), "real");
    EXPECT_EQ(find_type("nn = getKNN(0); x = nn[0] + length(nn);", "x"), "integer");
    EXPECT_EQ(find_type("nn = getKNN(0);", "nn"), "list");
}

TEST(ScriptTypes, a_power_of_integers_is_one_where_the_exponent_is_written) {
    EXPECT_EQ(find_type("y = 3; x = pow(y, 2);", "x"), "integer");
    EXPECT_EQ(find_type("y = 3; x = pow(2, y);", "x"), "real");
    EXPECT_EQ(find_type("y = 3; x = pow(y, -2);", "x"), "real");
    EXPECT_EQ(find_type("x = pow(10, 9);", "x"), "integer");
    EXPECT_EQ(find_type("x = pow(10, 10);", "x"), "real");
}

TEST(ScriptTypes, predefined_variables_follow_the_script) {
    EXPECT_EQ(find_type("X = 3;", "X"), "integer");
    EXPECT_EQ(find_type("X = 0.5;", "X"), "real");
    EXPECT_EQ(find_type("E = 3;", "E"), "real");
}

TEST(ScriptTypes, each_call_has_its_own_types) {
    const Program program = check_accepted("a = square(3); b = square(0.5); function square(x) { return x * x; }");
    ASSERT_EQ(program.functions.size(), 2u);
    EXPECT_EQ(program.functions[0].result, Type::integer);
    EXPECT_EQ(program.functions[1].result, Type::real);
}

TEST(ScriptTypes, declared_ones_stay_as_they_are) {
    EXPECT_EQ(find_type("float x; x = 1;", "x"), "real");
    EXPECT_EQ(find_type("int x; x = 1;", "x"), "integer");
    EXPECT_EQ(find_type("a = f(1); float f(x) { return x; }", "a"), "real");
    EXPECT_EQ(find_type("a = f(1); int f(float x) { return int(x); }", "x"), "real");
    EXPECT_EQ(find_type("int c[3]; x = c[0];", "x"), "integer");
    EXPECT_EQ(find_type("float c[3]; x = c[0];", "x"), "real");
}

TEST(ScriptTypes, exposed_ones_are_real_unless_ends_and_step_are_integers) {
    EXPECT_EQ(find_type("a = 50; expose a range 1, 100", "a"), "real");
    EXPECT_EQ(find_type("a = 50; expose a range 1, 100 step 1", "a"), "integer");
    EXPECT_EQ(find_type("a = 50; expose a range 1, 100 step 1.0", "a"), "real");
    EXPECT_EQ(find_type("a = 50; expose a range 1.0, 100 step 1", "a"), "real");
    EXPECT_EQ(find_type("int a = 50; expose a range 1, 100", "a"), "integer");
    EXPECT_EQ(find_codes("a = 0.5; expose a range 0, 2 step 1"), std::vector<std::string>{"E020"});
}

TEST(ScriptTypes, least_integer_can_be_written) {
    EXPECT_EQ(find_type("x = -2147483648;", "x"), "integer");
    EXPECT_EQ(find_type("x = 2147483648;", "x"), "real");
    EXPECT_EQ(find_type("x = 2147483647;", "x"), "integer");
    EXPECT_EQ(check_accepted("x = -2147483648;").variables.back().constant, -2147483648.0);
    EXPECT_EQ(check_accepted("x = 0xFFFFFFFF;").variables.back().constant, -1.0);
}

TEST(ScriptTypes, operands_of_arithmetic_have_one_type_after_checking) {
    const Program program =
        check_accepted("float f; f = 1; n = 2; g = f * n + (n < f) - min(n, f) + getPhotonPosition(n, X);");
    visit_expressions(program.body, [](const Expression& expression) {
        const bool is_logic =
            expression.operation == Operator::logical_and || expression.operation == Operator::logical_or;
        if (expression.kind == Expression::Kind::binary && !is_logic) {
            EXPECT_EQ(expression.operands[0].type, expression.operands[1].type);
        }
        if (expression.kind == Expression::Kind::builtin && expression.builtin->id == BuiltinId::min) {
            EXPECT_EQ(expression.operands[0].type, Type::real);
        }
        if (expression.kind == Expression::Kind::builtin && expression.builtin->id == BuiltinId::get_photon_position) {
            EXPECT_EQ(expression.operands[0].type, Type::integer);
        }
    });
}

} // namespace
} // namespace photonloupe::test
