// SPDX-License-Identifier: Apache-2.0
// Each limit is reached without complaint, refused one past, and far past it nothing breaks.
#include <gtest/gtest.h>

#include "script/compile_script.h"
#include "script/script_files.h"

namespace photonloupe::test {
namespace {

using Codes = std::vector<std::string>;

std::string repeat(const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i)
        all += text;
    return all;
}

TEST(ScriptLimits, sixty_four_levels_of_everything_that_nests) {
    struct Nest {
        const char *begin, *open, *middle, *close, *end;
    };
    const Nest nests[] = {
        {"x = ", "(", "1", ")", ";"},
        {"x = 1; y = ", "- ", "x", "", ";"},
        {"", "{", "x = 1;", "}", ""},
        {"", "if (1) {", "x = 1;", "}", ""},
        {"", "if (1) ", "x = 1;", "", ""},
        {"", "while (0) {", "x = 1;", "}", ""},
        {"x = ", "abs(", "1", ")", ";"},
        {"x = ", "1 ? ", "1", " : 2", ";"},
        {"float a[9]; x = ", "a[", "0", "]", ";"},
        {"x = ", "1 ? 2 : ", "1", "", ";"},
        {"", "do ", "x = 1;", " while (0);", ""},
    };
    for (const Nest& nest : nests) {
        const auto write = [&](int levels) {
            return nest.begin + repeat(nest.open, levels) + nest.middle + repeat(nest.close, levels) + nest.end;
        };
        EXPECT_EQ(find_codes(write(64)), Codes{}) << write(2);
        EXPECT_EQ(find_codes(write(65)), Codes{"E008"}) << write(2);
        const std::string far = write(5000);
        if (far.size() <= 65536) {
            EXPECT_EQ(find_codes(far), Codes{"E008"}) << write(2);
        }
    }
}

TEST(ScriptLimits, chains_are_longer_than_nests) {
    EXPECT_EQ(find_codes("x = 1" + repeat(" + 1", 250) + ";"), Codes{});
    EXPECT_EQ(find_codes("x = 1" + repeat(" + 1", 10000) + ";"), Codes{"E008"});
    EXPECT_EQ(find_codes(repeat("x = ", 250) + "1;"), Codes{});
    EXPECT_EQ(find_codes(repeat("x = ", 10000) + "1;"), Codes{"E008"});
    EXPECT_EQ(find_codes("if (0) ; " + repeat("else if (0) ;", 250)), Codes{});
    EXPECT_EQ(find_codes("if (0) ; " + repeat("else if (0) ;", 4000)), Codes{"E008"});
    EXPECT_EQ(find_codes("x = 1; " + repeat("x++;", 10000)), Codes{});
    EXPECT_EQ(find_codes("x = 1; y = x" + repeat("++", 10000) + ";").front(), "E008");
}

TEST(ScriptLimits, unfinished_nests_end_too) {
    for (const char* const open : {"(", "{", "[", "f(", "if (", "-", "!", "a ? ", "a = ", "x[", "while (1) ", "else ",
                                   "function f() {", "do ", "for (", "++", "a, ", "\"", "/*"}) {
        const std::string text = repeat(open, 60000 / int(std::string(open).size()));
        EXPECT_FALSE(find_codes(text).empty()) << open;
    }
}

TEST(ScriptLimits, calls_nest_with_all_they_hold) {
    std::string text = "function f0(x) { return x; }";
    for (int i = 1; i < 40; ++i)
        text += "function f" + std::to_string(i) + "(x) { return f" + std::to_string(i - 1) + "(x); }\n";
    EXPECT_EQ(find_codes(text + "y = f39(1);"), Codes{});
    for (int i = 40; i < 1000; ++i)
        text += "function f" + std::to_string(i) + "(x) { return f" + std::to_string(i - 1) + "(x); }\n";
    EXPECT_EQ(find_codes(text + "y = f999(1);").front(), "E008");
}

TEST(ScriptLimits, what_is_accepted_can_be_planned_and_emitted_too) {
    const std::string photons = "for (i = 0; i < getNumPhotons(); i++) ";
    const std::string sum = "x = i" + repeat(" + i", 250) + "; setPhotonColourEncoding(i, x, x, x);";
    const std::string parentheses = "x = " + repeat("(1.5 * abs(", 31) + "i" + repeat("))", 31) + ";";
    std::string calls;
    for (int i = 1; i < 40; ++i)
        calls += "function f" + std::to_string(i) + "(x) { return 1 + f" + std::to_string(i - 1) + "(x + 1) / 2; }\n";
    for (const std::string& text :
         {photons + "{" + sum + "}", photons + "{" + parentheses + "}", photons + repeat("if (i > 3) ", 60) + "x = i;",
          photons + "{ x = 0; if (x) ; " + repeat("else if (i < x) x = i;", 250) + "}",
          "function f0(x) { return x; }" + calls + photons + "setPhotonColourEncoding(i, f39(i), 0, 0);"}) {
        const auto compiled = script::compile_script({"deep.photon", text});
        EXPECT_EQ(script::format_diagnostics(compiled->program.source, compiled->diagnostics), "");
        ASSERT_EQ(compiled->plan.loops.size(), 1u);
    }
}

TEST(ScriptLimits, two_hundred_and_fifty_six_variables) {
    const auto write = [](int count) {
        std::string text;
        for (int i = 0; i < count; ++i)
            text += "v" + std::to_string(i) + " = 0;\n";
        return text;
    };
    EXPECT_EQ(find_codes(write(256)), Codes{});
    EXPECT_EQ(find_codes(write(257)), Codes{"E010"});
    EXPECT_EQ(find_codes(write(5000)), Codes{"E010"});
    // A function's count once, however often it is called.
    EXPECT_EQ(find_codes(write(200) + "function f() { a = b = c = d = e = g = h = 1; }" + repeat("f();", 50)), Codes{});
}

TEST(ScriptLimits, sixty_four_kibibytes) {
    EXPECT_EQ(find_codes("x = 1;" + std::string(65530, ' ')), Codes{});
    EXPECT_EQ(find_codes("x = 1;" + std::string(65531, ' ')), Codes{"E009"});
    EXPECT_EQ(find_codes(std::string(50'000'000, '(')), Codes{"E009"});
}

TEST(ScriptLimits, arrays) {
    EXPECT_EQ(find_codes("float a[4096]; float b[4096];"), Codes{});
    EXPECT_EQ(find_codes("float a[4097];"), Codes{"E011"});
    const std::string loop = "for (i = 0; i < getNumPhotons(); i++) ";
    EXPECT_EQ(find_codes(loop + "{ float a[512]; }"), Codes{});
    EXPECT_EQ(find_codes(loop + "{ float a[513]; }"), Codes{"E012"});
    EXPECT_EQ(find_codes(loop + "{ float a[300]; } " + loop + "{ float a[300]; }"), Codes{});
    EXPECT_EQ(find_codes(loop + "{ f(); f(); } function f() { int a[256]; }"), Codes{});
    EXPECT_EQ(find_codes(loop + "{ f(); f(); } function f() { int a[257]; }"), Codes{"E012"});
}

TEST(ScriptLimits, inlining_that_grows_without_end_is_refused) {
    std::string text = "function f0(x) { return x; }";
    for (int i = 1; i < 30; ++i)
        text += "function f" + std::to_string(i) + "(x) { return f" + std::to_string(i - 1) + "(f" +
                std::to_string(i - 1) + "(x)); }\n";
    EXPECT_EQ(find_codes(text + "y = f29(1);"), Codes{"E013"});
}

TEST(ScriptLimits, the_longest_scripts_are_checked_quickly) {
    std::string reversed = "v255 = 0.5;";
    for (int i = 0; i < 255; ++i)
        reversed =
            "v" + std::to_string(i) + " = 0; v" + std::to_string(i) + " = v" + std::to_string(i + 1) + ";" + reversed;
    find_codes(reversed);
    std::string wide = "a = b = c = 1;";
    while (wide.size() < 65000)
        wide += "if (a < b) { a += b * c; } else for (j = 0; j < 9; j++) { b -= a; }\n";
    EXPECT_EQ(find_codes(wide), Codes{});
}

} // namespace
} // namespace photonloupe::test
