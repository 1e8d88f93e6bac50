// SPDX-License-Identifier: Apache-2.0
// Which loops run over photons, and which have a provable bound.
#include <functional>

#include <gtest/gtest.h>

#include "script/script_files.h"

namespace photonloupe::test {
namespace {

using namespace script;

// One letter a loop, in the order of the tree: p over photons, b bounded, f with fuel. Functions' after the script's.
std::string describe_loops(const std::string& text) {
    const Program program = check_accepted(text);
    std::string loops;
    const std::function<void(const std::vector<Statement>&)> walk = [&](const std::vector<Statement>& statements) {
        for (const Statement& statement : statements) {
            if (statement.kind == Statement::Kind::photon_loop)
                loops += 'p';
            else if (statement.kind == Statement::Kind::loop)
                loops += statement.is_bounded ? 'b' : 'f';
            walk(statement.body);
            walk(statement.otherwise);
        }
    };
    walk(program.body);
    for (const Function& function : program.functions)
        walk(function.body);
    return loops;
}

TEST(ScriptLoops, over_photons_are_recognized_in_all_their_forms) {
    for (const char* const head :
         {"for (i = 0; i < getNumPhotons(); i++)", "for (i = 0; i < getNumPhotons(); ++i)",
          "for (i = 0; i < getNumPhotons(); i += 1)", "for (i = 0; i < getNumPhotons(); i = i + 1)",
          "for (i = 0; i < getNumPhotons(); i = 1 + i)", "for (int i = 0; i < getNumPhotons(); i++)",
          "for (i = 0; i <= getNumPhotons() - 1; i++)", "n = getNumPhotons(); for (i = 0; i < n; i++)",
          "int n = getNumPhotons(); for (i = 0; i <= n - 1; i++)",
          "m = getNumPhotons(); n = m; for (i = 0; n > i; i++)", "float n = getNumPhotons(); for (i = 0; i < n; i++)",
          "for (i = 0; n - 1 >= i; i++)"}) {
        const std::string start = std::string(head).starts_with("for (i = 0; n - 1") ? "n = getNumPhotons(); " : "";
        EXPECT_EQ(describe_loops(start + head + " { x = i; }"), "p") << head;
    }
}

TEST(ScriptLoops, that_only_look_like_it_are_ordinary) {
    for (const char* const text :
         {"for (i = 1; i < getNumPhotons(); i++) {}", "for (i = 0; i < getNumPhotons(); i += 2) {}",
          "for (i = 0; i <= getNumPhotons(); i++) {}", "for (i = 0; i < getNumPhotons() - 1; i++) {}",
          "n = getNumPhotons(); n = 5; for (i = 0; i < n; i++) {}",
          "n = getNumPhotons(); n--; for (i = 0; i < n; i++) {}", "for (i = 0; i < getNumPhotons(); i--) {}",
          "i = 0; while (i < getNumPhotons()) i++;", "for (i = 0, j = 0; i < getNumPhotons(); i++) {}",
          "j = 0; for (i = 0; i < getNumPhotons(); j++) { i++; }", "for (i = 0; i != getNumPhotons(); i++) {}",
          "if (getNumPhotons() > 3) n = getNumPhotons(); for (i = 0; i < n; i++) {}"})
        EXPECT_EQ(describe_loops(text).back(), 'f') << text;
}

TEST(ScriptLoops, over_photons_inside_one_another_are_ordinary_inside) {
    EXPECT_EQ(describe_loops("for (i = 0; i < getNumPhotons(); i++) for (j = 0; j < getNumPhotons(); j++) {}"), "pf");
    EXPECT_EQ(describe_loops("for (i = 0; i < getNumPhotons(); i++) f();"
                             "f(); function f() { for (k = 0; k < getNumPhotons(); k++) {} }"),
              "pfp");
}

TEST(ScriptLoops, over_photons_stand_under_uniform_control_flow) {
    EXPECT_EQ(describe_loops("t = 0; while (t < 3) { t++; if (t > 1) { for (i = 0; i < getNumPhotons(); i++) {} } }"),
              "fp");
}

TEST(ScriptLoops, over_photons_keep_a_counted_parameter) {
    EXPECT_EQ(describe_loops("f(getNumPhotons()); function f(n) { for (i = 0; i < n; i++) {} }"), "p");
    EXPECT_EQ(describe_loops("f(7); function f(n) { for (i = 0; i < n; i++) {} }"), "b");
}

TEST(ScriptLoops, that_count_are_bounded) {
    for (const char* const head :
         {"for (j = 0; j < 10; j++)", "for (j = 10; j > 0; j--)", "for (j = 10; j >= 0; j -= 2)",
          "for (j = 0; 10 > j; j++)", "for (int j = 0; j <= 999999 - 1; j += 1)", "for (j = -5; j < 5; j = j + 3)",
          "for (j = 0; j < getNumPathVertices(0); j++)", "for (j = getNumVertices(0) - 1; j > 0; j--)",
          "v = getNumPathVertices(0) - 2; for (j = 1; j < v - 1; j++)",
          "nn = getKNN(0); for (j = 0; j < length(nn); j++)", "nn = getKNN(0); m = length(nn); for (j = 0; j < m; j++)",
          "for (j = 0; j < 10 && random(j, 0) < 0.5; j++)", "for (j = 0; j < min(getNumPhotons(), 100); j++)",
          "for (j = 0; j < getNumPathVertices(0) / 2; j++)", "N = 7; for (j = 0; j < N; j++)"})
        EXPECT_EQ(describe_loops(std::string(head) + " { if (j == 3) continue; if (j == 5) break; }"), "b") << head;
}

TEST(ScriptLoops, that_may_not_end_need_fuel) {
    for (const char* const text :
         {"for (j = 0; j < 10; j++) { j = 0; }", "for (j = 0; j < 10; j--) {}", "for (j = 0; j < 1000001; j++) {}",
          "while (true) break;", "for (;;) break;", "for (j = 0; j != 10; j++) {}", "j = 0; for (; j < 10; j++) {}",
          "n = 1; n *= 2; for (j = 0; j < n; j++) {}", "for (j = 0; j < getNumPhotons() / 2; j++) {}",
          "for (j = 0; j < 10; j += 0) {}", "s = 1; s = 2; for (j = 0; j < 10; j += s) {}",
          "n = 3; expose n range 1, 10 step 1; for (j = 0; j < n; j++) {}", "for (j = 0; j < 10 || j > 20; j++) {}",
          "do { j = 1; } while (j < 0);", "for (j = 0.5; j < 10; j++) {}", "for (j = 0; j <= 2147483647; j++) {}"})
        EXPECT_EQ(describe_loops(text), "f") << text;
}

TEST(ScriptLoops, are_bounded_together) {
    EXPECT_EQ(describe_loops("for (a = 0; a < 999; a++) for (b = 0; b < 999; b++) {}"), "bb");
    EXPECT_EQ(describe_loops("for (a = 0; a < 999; a++) for (b = 0; b < 999; b++) for (c = 0; c < 2; c++) {}"), "bbf");
    EXPECT_EQ(describe_loops("for (a = 0; a < 10; a++) for (b = a + 1; b < 10; b++) for (c = b; c > a; c--) {}"),
              "bbb");
    EXPECT_EQ(describe_loops("while (random(0, 0) < 2) for (b = 0; b < 3; b++) {}"), "ff");
    EXPECT_EQ(
        describe_loops("while (random(0, 0) < 2) for (i = 0; i < getNumPhotons(); i++) for (b = 0; b < 3; b++) {}"),
        "fpb");
    EXPECT_EQ(describe_loops("for (a = 0; a < 2000; a++) f(); function f() { for (b = 0; b < 2000; b++) {} }"), "bf");
}

TEST(ScriptLoops, of_another_loops_variable_are_not_taken_for_bounded_elsewhere) {
    EXPECT_EQ(describe_loops("for (j = 0; j < 10; j++) {} j *= j; m = j; for (k = 0; k < m; k++) {}"), "bf");
}

} // namespace
} // namespace photonloupe::test
