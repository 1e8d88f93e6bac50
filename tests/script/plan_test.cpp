// SPDX-License-Identifier: Apache-2.0
// The parallel rules: loops just inside each, which become passes, and just outside, which run serially and say why.
#include "script/plan/plan.h"

#include <string>

#include <gtest/gtest.h>

#include "script/check/check_script.h"

namespace photonloupe::script {
namespace {

struct Planned {
    Program program;
    Diagnostics diagnostics;
    Plan plan;

    explicit Planned(const std::string& text) : program(check_script({"test", text}, diagnostics)) {
        if (!diagnostics.has_errors())
            plan = plan_photon_loops(program, diagnostics);
    }
    std::string describe() const { return format_diagnostics(program.source, diagnostics.sorted()); }
    VariableUse find_use(const std::string& name, std::size_t loop = 0) const {
        for (const auto& [variable, use] : plan.loops[loop].variables)
            if (program.variables[variable].name == name)
                return use;
        ADD_FAILURE() << "no variable " << name;
        return {};
    }
};

struct Case {
    const char* rule;
    const char* text;
    const char* says = ""; // a word of the warning
};

// After a declared parameter, so that bodies may set it.
std::string complete(const std::string& text) {
    return "declarePhotonParameter(3, 0, 1);\nn = "
           "getNumPhotons();\n" +
           text;
}

class Parallel : public ::testing::TestWithParam<Case> {};
class Serial : public ::testing::TestWithParam<Case> {};

TEST_P(Parallel, loop_becomes_a_pass) {
    const Planned planned(complete(GetParam().text));
    ASSERT_FALSE(planned.diagnostics.has_errors()) << planned.describe();
    ASSERT_FALSE(planned.plan.loops.empty());
    for (const PhotonLoop& loop : planned.plan.loops)
        EXPECT_TRUE(loop.is_parallel) << format_diagnostics(planned.program.source, loop.reasons);
}

TEST_P(Serial, loop_runs_serially_and_says_why) {
    const Planned planned(complete(GetParam().text));
    ASSERT_FALSE(planned.diagnostics.has_errors()) << planned.describe();
    ASSERT_FALSE(planned.plan.loops.empty());
    const PhotonLoop& loop = planned.plan.loops[0];
    ASSERT_FALSE(loop.is_parallel);
    ASSERT_FALSE(loop.reasons.empty());
    const std::string text = format_diagnostics(planned.program.source, loop.reasons);
    EXPECT_NE(text.find(GetParam().says), std::string::npos) << text;
    for (const Diagnostic& reason : loop.reasons) {
        EXPECT_EQ(reason.severity, Severity::warning);
        EXPECT_FALSE(reason.note.empty()) << "no rewrite is given: " << reason.message;
    }
}

constexpr Case PARALLEL[] = {
    {"local", "for (i = 0; i < n; i++) { x = i * 2; setPhotonParameter(i, 3, x); }"},
    {"local on both paths", "for (i = 0; i < n; i++) { if (i % 2 == 0) x = 1; else x = 2; setPhotonParameter(i, 3, "
                            "x); }"},
    {"local behind continue", "for (i = 0; i < n; i++) { if (i < 3) continue; x = 1; setPhotonParameter(i, 3, x); }"},
    {"local set by a loop that runs at least once", "for (i = 0; i < n; i++) { do { x = 1; } while (x > 2); "
                                                    "setPhotonParameter(i, 3, x); }"},
    {"local of a later loop too", "for (i = 0; i < n; i++) { x = i; } for (i = 0; i < n; i++) { x = 2; "
                                  "setPhotonParameter(i, 3, x); }"},
    {"local in a uniform loop", "for (t = 0; t < 3; t++) for (i = 0; i < n; i++) { x = t; setPhotonParameter(i, 3, "
                                "x); }"},
    {"assigned again before it is read after the loop", "for (i = 0; i < n; i++) { x = i; } x = 3; print(\"x\", x);"},
    {"array declared in the body", "for (i = 0; i < n; i++) { float c[4]; c[i % 4] += 2; setPhotonParameter(i, 3, "
                                   "c[1]); }"},
    {"loop variable read after the loop", "for (i = 0; i < n; i++) { x = i; } print(\"n\", i);"},
    {"uniform", "a = 4; for (i = 0; i < n; i++) setPhotonParameter(i, 3, a);"},
    {"uniform array", "float w[3]; w[1] = 2; for (i = 0; i < n; i++) setPhotonParameter(i, 3, w[i % 3]);"},
    {"sum", "s = 0; for (i = 0; i < n; i++) { s += i * 0.5; } print(\"s\", s);"},
    {"sum of differences", "s = 0; for (i = 0; i < n; i++) { s -= i; s += 3; } print(\"s\", s);"},
    {"count", "c = 0; for (i = 0; i < n; i++) { if (i > 3) c++; else c--; } print(\"c\", c);"},
    {"count in a for head", "c = 0; for (i = 0; i < n; i++) for (j = 0; j < 3; j++, c++) { x = j; } print(\"c\", c);"},
    {"written-out sum", "s = 0; for (i = 0; i < n; i++) { s = s + i; s = i + s; s = s - 1; } print(\"s\", s);"},
    {"sum under a condition", "s = 0; for (i = 0; i < n; i++) if (i % 2 == 0) { s += 1; } print(\"s\", s);"},
    {"sum that is read by no one", "s = 0; for (i = 0; i < n; i++) { s += 1; }"},
    {"minimum", "s = 9; for (i = 0; i < n; i++) { s = min(s, i); s = min(i * 2, s); } print(\"s\", s);"},
    {"maximum", "s = 9.5; for (i = 0; i < n; i++) { s = max(s, i); } print(\"s\", s);"},
    {"minimum by if", "s = 9; for (i = 0; i < n; i++) if (i < s) s = i; print(\"s\", s);"},
    {"maximum by if, turned around", "s = 9; for (i = 0; i < n; i++) { if (s < i) { s = i; } } print(\"s\", s);"},
    {"arg-min", "s = 1e9; k = -1; for (i = 0; i < n; i++) { e = i * 0.5; if (e < s) { s = e; k = i; } } "
                "print(\"k\", k, s);"},
    {"arg-max", "s = -1; k = -1; for (i = 0; i < n; i++) { e = getPhotonPower(i, 0); if (s < e) { s = e; k = i; } } "
                "print(\"k\", k, s);"},
    {"arg-max of a call, written twice", "s = -1; k = -1; for (i = 0; i < n; i++) if (getPhotonPower(i, 0) > s) { s "
                                         "= getPhotonPower(i, 0); k = i; } print(\"k\", k, s);"},
    {"arg-min with more than one", "s = 9; a = 0; b = 0; for (i = 0; i < n; i++) if (i < s) { b = i * 2; s = i; a = "
                                   "3; } print(\"k\", a, b);"},
    {"arg-min in an inner loop", "s = 9; a = 0; b = 0; for (i = 0; i < n; i++) for (j = 0; j < 4; j++) { d = i * j; "
                                 "if (d < s) { s = d; a = i; b = j; } } print(\"k\", a, b);"},
    {"array sums", "float h[8]; for (i = 0; i < n; i++) { k = i % 8; h[k] += 0.5; h[k]++; h[3] = h[3] + 1; } "
                   "print(\"h\", h[2]);"},
    {"array minimum", "float h[8]; for (i = 0; i < n; i++) { h[i % 8] = min(h[i % 8], i); } print(\"h\", h[2]);"},
    {"array maximum by if", "float h[8]; for (i = 0; i < n; i++) if (i > h[i % 8]) h[i % 8] = i; print(\"h\", h[2]);"},
    {"array arg-max", "float h[8]; int who[8]; for (i = 0; i < n; i++) { k = i % 8; if (i > h[k]) { h[k] = i; "
                      "who[k] = i; } } print(\"h\", h[2], who[2]);"},
    {"loop through a function's parameter", "function f(p) { setPhotonParameter(p, 3, 1); } for (i = 0; i < n; i++) "
                                            "f(i);"},
    {"through two functions", "function g(q) { setPhotonParameter(q, 3, getPhotonParameter(q, 3)); } function f(p) "
                              "{ g(p); } for (i = 0; i < n; i++) f(i);"},
    {"a function's own names", "function f(a) { t = a * 2; return t; } for (i = 0; i < n; i++) "
                               "setPhotonParameter(i, 3, f(i) + f(2));"},
    {"own parameters read while set", "for (i = 0; i < n; i++) setPhotonParameter(i, 3, getPhotonParameter(i, 3) + "
                                      "1);"},
    {"others' position read while parameters are set", "for (i = 0; i < n; i++) setPhotonParameter(i, 3, "
                                                       "getPhotonParameter((i + 1) % n, 0));"},
    {"others' parameters read", "for (i = 0; i < n; i++) { x = getPhotonParameter(n - 1 - i, 3); "
                                "setPhotonColourEncoding(i, x, x, x); }"},
    {"local PCA", "for (i = 0; i < n; i++) { resetPCA2D(); pushPCA2D(i, 1); pushPCA2D(2, i); if (decomposePCA2D() "
                  "== 0) continue; setPhotonParameter(i, 3, getPCAEigenvalue(0)); }"},
    {"global PCA", "for (i = 0; i < n; i++) { pushPCA3D(i, 1, 2); } if (decomposePCA3D()) { print(\"v\", "
                   "getPCAEigenvalue(0)); }"},
    {"decomposition from before", "pushPCA2D(1, 2); pushPCA2D(3, 4); decomposePCA2D(); for (i = 0; i < n; i++) "
                                  "setPhotonParameter(i, 3, getPCAEigenvector(0, 1));"},
    {"break of an inner loop", "for (i = 0; i < n; i++) for (j = 0; j < 9; j++) if (j > i) break;"},
    {"return of a function", "function f(a) { for (j = 0; j < 5; j++) if (j > a) return j; return 0; } for (i = 0; "
                             "i < n; i++) setPhotonParameter(i, 3, f(i));"},
    {"neighbours", "for (i = 0; i < n; i++) { nn = getKNN(i, 5); s = 0; for (j = 0; j < length(nn); j++) s += "
                   "nn[j]; setPhotonParameter(i, 3, s); }"},
    {"k-means", R"(
float cx[8]; float cy[8]; float sx[8]; float sy[8]; int count[8];
for (c = 0; c < 8; c++) { cx[c] = random(c, 1); cy[c] = random(c, 2); }
moved = 1;
while (moved > 0.001) {
  for (c = 0; c < 8; c++) { sx[c] = 0; sy[c] = 0; count[c] = 0; }
  for (i = 0; i < n; i++) {
    best = 1e30; who = 0;
    for (c = 0; c < 8; c++) {
      d = magnitude(getPhotonNormal(i, X) - cx[c], getPhotonNormal(i, Y) - cy[c]);
      if (d < best) { best = d; who = c; }
    }
    sx[who] += getPhotonNormal(i, X); sy[who] += getPhotonNormal(i, Y); count[who]++;
    setPhotonParameter(i, 3, who);
  }
  moved = 0;
  for (c = 0; c < 8; c++) if (count[c] > 0) {
    x = sx[c] / count[c]; y = sy[c] / count[c];
    moved = max(moved, magnitude(x - cx[c], y - cy[c])); cx[c] = x; cy[c] = y;
  }
})"},
    {"histogram", "for (i = 0; i < n; i++) histogram(\"h\", i, 0, 10);"},
};

constexpr Case SERIAL[] = {
    {"local on one path",
     "for (i = 0; i < n; i++) { if (i % 2 == 0) x = 1; setPhotonParameter(i, 3, x); } x = "
     "0;",
     "'x'"},
    {"set by a loop that may not run",
     "for (i = 0; i < n; i++) { for (j = 0; j < i; j++) x = 1; "
     "setPhotonParameter(i, 3, x); }",
     "'x'"},
    {"read before it is assigned", "x = 0; for (i = 0; i < n; i++) { setPhotonParameter(i, 3, x); x = i; }", "'x'"},
    {"read after the loop", "for (i = 0; i < n; i++) { x = i * 2; } print(\"x\", x);", "read after the loop (line 3)"},
    {"read around a uniform loop",
     "x = 0; for (t = 0; t < 3; t++) { y = x; for (i = 0; i < n; i++) { x = i; } "
     "}",
     "'x'"},
    {"array written at a place", "float a[4]; for (i = 0; i < n; i++) { a[i % 4] = i; }  print(\"a\", a[0]);", "'a'"},
    {"sum and read", "s = 0; for (i = 0; i < n; i++) { s += 1; setPhotonParameter(i, 3, s); } print(\"s\", s);", "'s'"},
    {"sum in its own operand", "s = 0; for (i = 0; i < n; i++) { s += s + 1; } print(\"s\", s);", "'s'"},
    {"value of the sum is used", "s = 0; for (i = 0; i < n; i++) { x = s += 1; } print(\"s\", s);", "'s'"},
    {"sum and product", "s = 0; for (i = 0; i < n; i++) { s += 1; s *= 2; } print(\"s\", s);", "'s'"},
    {"product", "s = 1; for (i = 0; i < n; i++) { s *= 2; } print(\"s\", s);", "'s'"},
    {"difference the wrong way", "s = 1; for (i = 0; i < n; i++) { s = i - s; } print(\"s\", s);", "'s'"},
    {"sum and minimum", "s = 1; for (i = 0; i < n; i++) { s += 2; s = min(s, i); } print(\"s\", s);", "'s' is both"},
    {"minimum and maximum",
     "s = 1; for (i = 0; i < n; i++) { s = min(s, i); s = max(s, 2); } print(\"s\", "
     "s);",
     "'s' is both"},
    {"sum that starts anew", "s = 1; for (i = 0; i < n; i++) { s += 2; if (i == 7) s = 0; } print(\"s\", s);", "'s'"},
    {"arg-min that is read",
     "s = 9; k = 0; for (i = 0; i < n; i++) { if (i < s) { s = i; k = i; } "
     "setPhotonParameter(i, 3, k); } print(\"k\", k);",
     "'k'"},
    {"arg-min that is assigned elsewhere",
     "s = 9; k = 0; for (i = 0; i < n; i++) { k = 2; if (i < s) { s = i; k = "
     "i; } } print(\"k\", k);",
     "'k'"},
    {"arg-min that tells whether it won",
     "s = 9; for (i = 0; i < n; i++) { k = 0; if (i < s) { s = i; k = 1; } "
     "setPhotonParameter(i, 3, k); } print(\"s\", s);",
     "'s'"},
    {"arg-min, ties to the last",
     "s = 9; k = 0; for (i = 0; i < n; i++) { if (i <= s) { s = i; k = i; } } "
     "print(\"k\", k);",
     "'s'"},
    {"arg-min of something else",
     "s = 9; k = 0; for (i = 0; i < n; i++) { if (i < s) { s = i + 1; k = i; } } "
     "print(\"k\", k);",
     "'s'"},
    {"arg-min with an else",
     "s = 9; k = 0; for (i = 0; i < n; i++) { if (i < s) { s = i; } else k = i; } "
     "print(\"k\", k, s);",
     "'s'"},
    {"arg-min whose second part is missing once",
     "s = 9; k = 0; for (i = 0; i < n; i++) { if (i < s) { s = i; k = "
     "i; } if (2 * i < s) { s = 2 * i; } } print(\"k\", k);",
     "'k'"},
    {"array arg-min with a scalar",
     "float h[8]; k = 0; for (i = 0; i < n; i++) { if (i < h[i % 8]) { h[i % 8] = i; "
     "k = i; } } print(\"k\", k, h[0]);",
     "'h'"},
    {"array minimum at another place",
     "float h[8]; for (i = 0; i < n; i++) { if (i < h[i % 8]) h[i % 4] = i; } "
     "print(\"h\", h[0]);",
     "'h'"},
    {"array sum and read",
     "float h[8]; for (i = 0; i < n; i++) { h[i % 8] += 1; x = h[0]; } print(\"h\", "
     "h[0]);",
     "'h'"},
    {"array sum in its own index",
     "int h[8]; for (i = 0; i < n; i++) { h[h[0] % 8] += 1; } print(\"h\", "
     "h[0]);",
     "'h'"},
    {"break", "for (i = 0; i < n; i++) { if (i > 5) break; }", "break"},
    {"parameter of another photon set",
     "for (i = 0; i < n; i++) { setPhotonParameter((i + 1) % n, 3, 1); "
     "}",
     "setPhotonParameter"},
    {"parameter of a copy of the photon set",
     "for (i = 0; i < n; i++) { p = i; setPhotonParameter(p, 3, 1); "
     "}",
     "setPhotonParameter"},
    {"color of another photon set",
     "for (i = 0; i < n; i++) { setPhotonColourEncoding(0, 1, 1, 1); "
     "}",
     "setPhotonColourEncoding"},
    {"others' parameters read while set",
     "for (i = 0; i < n; i++) { setPhotonParameter(i, 3, getPhotonParameter(0, "
     "3)); }",
     "getPhotonParameter"},
    {"PCA without a reset",
     "for (i = 0; i < n; i++) { pushPCA2D(i, 1); decomposePCA2D(); setPhotonParameter(i, 3, "
     "getPCAEigenvalue(0)); }",
     "reset"},
    {"PCA reset on one path",
     "for (i = 0; i < n; i++) { if (i > 3) resetPCA2D(); pushPCA2D(i, 1); "
     "decomposePCA2D(); }",
     "reset"},
    {"decomposition read after the loop",
     "for (i = 0; i < n; i++) { resetPCA2D(); pushPCA2D(i, 1); "
     "decomposePCA2D(); } print(\"v\", getPCAEigenvalue(0));",
     "decomposition"},
    {"last PCA decomposed after the loop",
     "for (i = 0; i < n; i++) { resetPCA2D(); pushPCA2D(i, 1); } "
     "decomposePCA2D();",
     "PCA"},
    {"function writes at another photon",
     "function f(p) { p = p + 1; setPhotonParameter(p, 3, 1); } for (i = 0; i "
     "< n; i++) f(i);",
     "setPhotonParameter"},
};

std::string name_case(const ::testing::TestParamInfo<Case>& info) {
    std::string name;
    for (const char c : std::string(info.param.rule))
        name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(Plan, Parallel, ::testing::ValuesIn(PARALLEL), name_case);
INSTANTIATE_TEST_SUITE_P(Plan, Serial, ::testing::ValuesIn(SERIAL), name_case);

TEST(Plan, every_use_has_its_role) {
    const Planned planned(complete(R"(
a = 2; s = 0; lo = 9; hi = 0; least = 9; who = 0;
for (i = 0; i < n; i++) {
  x = a * i; s += x; lo = min(lo, x); hi = max(x, hi);
  if (x < least) { least = x; who = i; }
}
print("all", s, lo, hi, least, who);)"));
    EXPECT_EQ(planned.find_use("a").role, Role::uniform);
    EXPECT_EQ(planned.find_use("x").role, Role::local);
    EXPECT_EQ(planned.find_use("s").role, Role::sum);
    EXPECT_EQ(planned.find_use("lo").role, Role::minimum);
    EXPECT_EQ(planned.find_use("hi").role, Role::maximum);
    EXPECT_EQ(planned.find_use("least").role, Role::least);
    EXPECT_EQ(planned.find_use("who").role, Role::payload);
    EXPECT_EQ(planned.program.variables[planned.find_use("who").of].name, "least");
    EXPECT_EQ(planned.plan.loops[0].choices.size(), 1u);
}

TEST(Plan, a_least_value_within_an_iteration_is_no_reduction) {
    const Planned planned(complete("for (i = 0; i < n; i++) { b = 9; for (j = 0; j < 4; j++) { d = i * j; if (d < "
                                   "b) b = d; } "
                                   "setPhotonParameter(i, 3, b); }"));
    EXPECT_EQ(planned.find_use("b").role, Role::local);
    EXPECT_TRUE(planned.plan.loops[0].choices.empty());
}

TEST(Plan, setting_and_querying_parameters_in_one_loop_is_an_error) {
    for (const char* query : {"getParameterKNN(i, 9)", "getConstrainedKNN(i, 9, 3)"}) {
        const Planned planned(complete("for (i = 0; i < n; i++) {\n nn = " + std::string(query) +
                                       ";\n setPhotonParameter(i, 3, nn[0]); }"));
        ASSERT_TRUE(planned.diagnostics.has_errors()) << query;
        const Diagnostic error = planned.diagnostics.sorted()[0];
        EXPECT_EQ(error.code, "E070");
        EXPECT_NE(error.note.find("split the loop"), std::string::npos);
        EXPECT_EQ(planned.program.source.find_place(error.span.begin).line, 4u);
    }
}

TEST(Plan, world_neighbors_and_setting_parameters_go_together) {
    const Planned planned(complete("for (i = 0; i < n; i++) { nn = getKNN(i, 9); setPhotonParameter(i, 3, nn[0]); }"));
    EXPECT_FALSE(planned.diagnostics.has_errors()) << planned.describe();
    EXPECT_TRUE(planned.plan.loops[0].is_parallel);
}

TEST(Plan, queries_know_whether_their_photon_is_the_loops) {
    const Planned planned(complete(R"(
function f(p, k) { nn = getKNN(p, k); return nn[0]; }
for (i = 0; i < n; i++) { a = getKNN(i); b = getKNN(a[0], 7); x = f(i, 12); })"));
    const PhotonLoop& loop = planned.plan.loops[0];
    ASSERT_EQ(loop.queries.size(), 3u);
    EXPECT_TRUE(loop.queries[0].is_at_loop_photon);
    EXPECT_FALSE(loop.queries[0].count.has_value());
    EXPECT_FALSE(loop.queries[1].is_at_loop_photon);
    EXPECT_TRUE(loop.queries[2].is_at_loop_photon);
    ASSERT_TRUE(loop.queries[2].count.has_value());
    EXPECT_EQ(find_constant(planned.program, loop, *loop.queries[2].count), 12.0);
}

TEST(Plan, only_columns_that_are_read_are_asked_for) {
    const Planned planned(complete("for (i = 0; i < n; i++) { x = getPhotonParameter(i, 1) + getPathVertex(i, 0, "
                                   "X); }"));
    EXPECT_EQ(planned.plan.loops[0].columns, COLUMN_POSITION | COLUMN_PATH_STARTS | COLUMN_PATH_VERTICES);
}

TEST(Plan, only_loops_without_a_bound_need_fuel) {
    const Planned bounded(complete("for (i = 0; i < n; i++) for (j = 0; j < getNumPathVertices(i); j++) x = j;"));
    EXPECT_FALSE(bounded.plan.loops[0].needs_fuel);
    const Planned endless(complete("for (i = 0; i < n; i++) { x = i; while (x > 1) x /= 2; }"));
    EXPECT_TRUE(endless.plan.loops[0].needs_fuel);
}

TEST(Plan, variables_that_may_be_unset_are_known) {
    const Planned planned(complete("if (n > 3) u = 2; for (i = 0; i < n; i++) { float x; if (i > 2) x = 1; y = x + "
                                   "u; z = y; }"));
    const PhotonLoop& loop = planned.plan.loops[0];
    std::set<std::string> names;
    for (const std::uint32_t variable : loop.unset_reads)
        names.insert(planned.program.variables[variable].name);
    EXPECT_EQ(names, (std::set<std::string>{"u", "x"}));
}

TEST(Plan, a_deep_nest_of_loops_is_planned_in_no_time) {
    std::string text = "for (i = 0; i < n; i++) {";
    for (int depth = 0; depth < 40; ++depth)
        text += "while (x" + std::to_string(depth) + " < 1) { x" + std::to_string(depth) + " = 1; ";
    const Planned planned(complete("x0 = 0;" + text + std::string(41, '}')));
    SUCCEED();
}

} // namespace
} // namespace photonloupe::script
