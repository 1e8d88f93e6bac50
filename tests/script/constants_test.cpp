// SPDX-License-Identifier: Apache-2.0
// Values known when the script is compiled, and what hangs on them.
#include <cmath>

#include <gtest/gtest.h>

#include "script/script_files.h"

namespace photonloupe::test {
namespace {

using namespace script;

using Codes = std::vector<std::string>;

std::optional<double> find_constant(const std::string& text, const std::string& name) {
    for (const Variable& variable : check_accepted(text).variables)
        if (variable.name == name)
            return variable.constant;
    return std::nullopt;
}

TEST(ScriptConstants, are_variables_given_one_value_everywhere) {
    EXPECT_EQ(find_constant("X = 0;", "X"), 0.0);
    EXPECT_EQ(find_constant("x = 1;", "Y"), 1.0);
    EXPECT_EQ(find_constant("X = 1;", "X"), std::nullopt);
    EXPECT_EQ(find_constant("GAMMA = 3; if (GAMMA > 2) GAMMA = 1 + 2;", "GAMMA"), 3.0);
    EXPECT_EQ(find_constant("b = 2; a = b * 3 - 1;", "a"), 5.0);
    EXPECT_EQ(find_constant("a = 1; a++;", "a"), std::nullopt);
    EXPECT_EQ(find_constant("a = 1; expose a range 0, 2;", "a"), std::nullopt);
    EXPECT_EQ(find_constant("a = getNumPhotons();", "a"), std::nullopt);
    EXPECT_EQ(find_constant("a = 0.1;", "a"), double(0.1f));
    EXPECT_EQ(find_constant("a = 0.0; a = -0.0;", "a"), std::nullopt);
    EXPECT_EQ(find_constant("n = getNumPhotons(); if (n > 1) a = 2; b = a;", "b"), std::nullopt); // a may hold nothing
    EXPECT_EQ(find_constant("x = 1;", "E"), double(float(M_E)));
    EXPECT_EQ(find_constant("a = 2147483647 + 1;", "a"), -2147483648.0);
    EXPECT_EQ(find_constant("a = max(3, 4) + sqrt(16) + int(2.9) + (1 < 2 ? 10 : 20);", "a"), 20.0);
    EXPECT_EQ(find_constant("a = 5 % 3 + -5 % 3 + mod(-5, 3);", "a"), 1.0);
    EXPECT_EQ(find_constant("f(7); function f(d) { print(\"d\", d); }", "d"), 7.0);
}

TEST(ScriptConstants, decide_sizes_of_arrays) {
    const Program program = check_accepted("N = 8; float a[N * 2 + 1]; int b[int(sqrt(N * 2))];");
    EXPECT_EQ(program.variables[program.variables.size() - 2].array_size, 17u);
    EXPECT_EQ(program.variables.back().array_size, 4u);
}

TEST(ScriptConstants, are_seen_through_variables_where_ranges_are_checked) {
    EXPECT_EQ(find_codes("W = 3; x = getPhotonPosition(0, W);"), Codes{"E022"});
    EXPECT_EQ(find_codes("W = 3; W = 2; x = getPhotonPosition(0, W);"), Codes{});
    EXPECT_EQ(find_codes("x = f(5); function f(axis) { return getPhotonPosition(0, axis); }"), Codes{"E022"});
    EXPECT_EQ(find_codes("float a[3]; x = a[1 + 2];"), Codes{"E021"});
    EXPECT_EQ(find_codes("float a[3]; x = a[2.0];"), Codes{});
    EXPECT_EQ(find_codes("k = 1001; nn = getKNN(0, k);"), Codes{"E025"});
}

TEST(ScriptConstants, may_stand_for_k_inside_a_photon_loop) {
    const std::string loop = "for (i = 0; i < getNumPhotons(); i++) ";
    EXPECT_EQ(find_codes(loop + "{ k = 20; nn = getKNN(i, k); }"), Codes{});
    EXPECT_EQ(find_codes("k = getNumPhotons(); " + loop + "{ nn = getKNN(i, min(k, 100)); }"), Codes{});
    EXPECT_EQ(find_codes(loop + "{ x = f(i, 7, 0.5); } function f(i, k, beta) { k2 = 1; "
                                "nn = getConstrainedKNN(i, k * 2, beta + k2); return nn[0]; }"),
              Codes{});
    EXPECT_EQ(find_codes(loop + "{ k = i; nn = getKNN(i, k); }"), Codes{"E026"});
    EXPECT_EQ(find_codes(loop + "{ x = f(i, i); } function f(i, k) { nn = getKNN(i, k); return nn[0]; }"),
              Codes{"E026"});
    EXPECT_EQ(find_codes(loop + "{ nn = getKNN(i, decomposePCA2D() + 1); }"), Codes{"E026"});
}

TEST(ScriptConstants, replace_parameters_in_k_so_that_it_can_be_computed_before_the_loop) {
    const Program program = check_accepted("n = getNumPhotons(); for (i = 0; i < n; i++) f(i, min(n, 9));"
                                           "function f(i, k) { nn = getKNN(i, k); print(\"n\", nn[0]); }");
    const Expression& call = program.functions[0].body[1].value->operands[0];
    ASSERT_EQ(call.kind, Expression::Kind::builtin);
    EXPECT_EQ(call.operands[1].kind, Expression::Kind::builtin);
    EXPECT_EQ(call.operands[1].operands[0].variable, program.exposed.size() + std::size(PREDEFINED_VALUES));
}

TEST(ScriptExposed, have_the_default_they_hold_where_they_are_exposed) {
    const auto find = [](const std::string& text) {
        const Program program = check_accepted(text);
        return program.variables.at(program.exposed.at(0)).default_value;
    };
    EXPECT_EQ(find("a = 50; expose a range 1, 1000"), 50.0);
    EXPECT_EQ(find("a = 1; a = 2 * 3; expose a range 1, 10; a = 4;"), 6.0);
    EXPECT_EQ(find("b = 2; { a = b / 4; expose a range 0, 1 }"), 0.5);
    EXPECT_EQ(find("expose X range -1, 1"), 0.0);
    EXPECT_EQ(find_codes("a = 1; if (getNumPhotons() > 2) a = 2; expose a range 0, 3"), Codes{"E027"});
    EXPECT_EQ(find_codes("a = 1; a += 1; expose a range 0, 3"), Codes{"E027"});
}

TEST(ScriptExposed, end_where_the_next_statement_begins) {
    check_accepted("a = 1; expose a range 0, 3\nstep = 4; step += a;");
    check_accepted("a = 1; expose a range -2, +3 step 0.5\nb = a;");
    check_accepted("a = 1; { expose a range 0, 3 }");
    EXPECT_EQ(find_codes("a = 1; expose a range 0, 3 b = 2;"), Codes{"E005"});
    EXPECT_EQ(find_codes("a = 1; expose a range 0, 2 + 1;"), Codes{"E005"});
}

} // namespace
} // namespace photonloupe::test
