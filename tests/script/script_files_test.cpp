// SPDX-License-Identifier: Apache-2.0
// Every script to accept is accepted; every script to reject is, with exactly the complaints written in it.
#include <set>

#include <gtest/gtest.h>

#include "script/compile_script.h"
#include "script/read/diagnostic_codes.h"
#include "script/script_files.h"

namespace photonloupe::test {
namespace {

using script::Source;

TEST(ScriptFiles, all_of_accept_are_accepted) {
    ASSERT_GE(list_scripts("accept").size(), 10u);
    for (const auto& path : list_scripts("accept")) {
        const Source source = read_script(path);
        EXPECT_EQ(script::format_diagnostics(source, compile_for_diagnostics(source)), "") << path;
    }
}

TEST(ScriptFiles, all_of_reject_are_rejected_as_they_say) {
    for (const auto& path : list_scripts("reject")) {
        const Source source = read_script(path);
        const std::vector<script::Diagnostic> diagnostics = compile_for_diagnostics(source);
        auto found = describe_found(source, diagnostics);
        const auto expected = read_expected(source);
        ASSERT_EQ(found.size(), expected.size()) << path << '\n' << script::format_diagnostics(source, diagnostics);
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (expected[i].column == 0)
                found[i].line = found[i].column = found[i].width = 0;
            if (const std::size_t cut = expected[i].message.find("..."); cut != std::string::npos)
                found[i].message = found[i].message.substr(0, cut) + "...";
            EXPECT_EQ(to_text(found[i]), to_text(expected[i])) << path;
        }
    }
}

TEST(ScriptFiles, every_code_has_a_script_that_is_rejected_for_it) {
    std::set<std::string> seen;
    for (const auto& path : list_scripts("reject"))
        for (const auto& expected : read_expected(read_script(path)))
            seen.insert(expected.code);
    for (const script::DiagnosticCode& code : script::list_diagnostic_codes())
        EXPECT_TRUE(seen.contains(std::string(code.code))) << code.code << ' ' << code.meaning;
    for (const std::string& code : seen) {
        const auto table = script::list_diagnostic_codes();
        EXPECT_TRUE(std::any_of(table.begin(), table.end(), [&](const auto& row) { return row.code == code; })) << code;
    }
}

TEST(ScriptFiles, what_the_paper_writes_is_accepted) {
    for (const auto& path : list_scripts("paper")) {
        const Source source = read_script(path);
        const auto compiled = script::compile_script(source);
        EXPECT_EQ(script::format_diagnostics(source, compiled->diagnostics), "");
        ASSERT_EQ(compiled->plan.loops.size(), 1u) << path;
        EXPECT_TRUE(compiled->plan.loops[0].is_parallel) << path;
    }
}

} // namespace
} // namespace photonloupe::test
