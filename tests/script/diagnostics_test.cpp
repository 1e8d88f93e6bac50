// SPDX-License-Identifier: Apache-2.0
// How complaints look: place, line, caret, note; whatever bytes the script is made of.
#include "script/read/diagnostics.h"

#include <gtest/gtest.h>

#include "script/script_files.h"

namespace photonloupe::test {
namespace {

using namespace script;

std::string format_first(const std::string& text) {
    const Source source{"a.photon", text};
    const std::vector<Diagnostic> found = find_diagnostics(text);
    return found.empty() ? "nothing" : format_diagnostic(source, found.front());
}

TEST(ScriptDiagnostics, show_place_line_caret_and_note) {
    EXPECT_EQ(format_first("X = 0;\n  x0 = getPathVertx(0, 1, X);\n"),
              "a.photon:2:8: error E004: unknown function 'getPathVertx'\n"
              "  x0 = getPathVertx(0, 1, X);\n"
              "       ^^^^^^^^^^^^ did you mean 'getPathVertex(photon, vertex, axis)'?\n");
}

TEST(ScriptDiagnostics, keep_tabs_so_that_carets_stand_under_the_span) {
    EXPECT_EQ(format_first("\tx =\tfoo;"), "a.photon:1:6: error E006: unknown variable 'foo'\n"
                                           "\tx =\tfoo;\n"
                                           "\t   \t^^^\n");
}

TEST(ScriptDiagnostics, count_code_points_not_bytes) {
    EXPECT_EQ(format_first("/* é€𝄞 */ x = foo;"), "a.photon:1:15: error E006: unknown variable 'foo'\n"
                                                  "/* é€𝄞 */ x = foo;\n"
                                                  "              ^^^\n");
}

TEST(ScriptDiagnostics, show_control_characters_and_bad_bytes_as_question_marks) {
    EXPECT_EQ(format_first("/* \x1b[2J \xff */ x = foo;"), "a.photon:1:18: error E006: unknown variable 'foo'\n"
                                                           "/* ?[2J ? */ x = foo;\n"
                                                           "                 ^^^\n");
}

TEST(ScriptDiagnostics, show_only_part_of_a_very_long_line) {
    const std::string text = format_first(std::string(5000, ' ') + "x = foo;" + std::string(5000, ' '));
    EXPECT_LT(text.size(), 600u);
    EXPECT_NE(text.find("^^^"), std::string::npos);
    EXPECT_NE(text.find("a.photon:1:5005:"), std::string::npos);
}

TEST(ScriptDiagnostics, point_behind_the_last_line_at_the_end_of_the_script) {
    EXPECT_EQ(format_first("x = 1"), "a.photon:1:6: error E005: expected ';' after this statement\n"
                                     "x = 1\n"
                                     "     ^\n");
    EXPECT_EQ(format_first("x = \n"), "a.photon:2:1: error E005: expected a value, found the end of the script\n"
                                      "\n"
                                      "^\n");
}

TEST(ScriptDiagnostics, know_all_line_breaks) {
    for (const char* const text : {"a = 1;\n\nx = foo;", "a = 1;\r\n\r\nx = foo;", "a = 1;\r\rx = foo;"})
        EXPECT_TRUE(format_first(text).starts_with("a.photon:3:5: ")) << format_first(text);
}

TEST(ScriptDiagnostics, are_at_most_twenty_errors_in_source_order) {
    std::string text;
    for (int i = 0; i < 50; ++i)
        text += "x = foo" + std::to_string(i) + ";\n";
    const std::vector<Diagnostic> found = find_diagnostics(text);
    ASSERT_EQ(found.size(), 20u);
    for (int i = 0; i < 20; ++i)
        EXPECT_EQ(found[i].message, "unknown variable 'foo" + std::to_string(i) + "'");
}

TEST(ScriptDiagnostics, tell_a_mistake_in_a_function_once_however_often_it_is_called) {
    EXPECT_EQ(find_codes("a = f(1) + f(2) + f(0.5); function f(x) { return foo; }"), std::vector<std::string>{"E006"});
}

TEST(ScriptDiagnostics, do_not_blame_what_could_not_be_read_for_being_missing) {
    EXPECT_EQ(find_codes("a = = 1; b = a; c = getPhotonPower(0, 7);"), (std::vector<std::string>{"E005", "E022"}));
}

TEST(ScriptDiagnostics, suggest_names_of_other_case_first) {
    const std::vector<Diagnostic> found = find_diagnostics("hua = 1; Hue = 2; x = hue;");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].note, "a function is called with parentheses: hue(angle, channel)");
    EXPECT_EQ(find_diagnostics("x = f; function f(a, b) { return a; }")[0].note,
              "a function is called with parentheses: f(a, b)");
    EXPECT_EQ(find_diagnostics("float table[3]; x = table(1);")[0].note, "an element is written table[j]");
    EXPECT_EQ(find_diagnostics("alpha1 = 1; Alphas = 2; x = ALPHAS;")[0].note, "did you mean 'Alphas'?");
    EXPECT_EQ(find_diagnostics("x = abcdefgh;")[0].note, "");
    EXPECT_EQ(find_diagnostics("function spread(a, b) { return a; } x = sprad(1, 2);")[0].note,
              "did you mean 'spread(a, b)'?");
}

TEST(ScriptDiagnostics, are_the_what_of_a_script_error) {
    const Source source{"a.photon", "x = foo;"};
    const ScriptError error(source, find_diagnostics(source.text));
    EXPECT_EQ(std::string(error.what()), format_diagnostics(source, error.diagnostics()));
    EXPECT_EQ(error.diagnostics().size(), 1u);
}

} // namespace
} // namespace photonloupe::test
