// SPDX-License-Identifier: Apache-2.0
// Reads the test scripts and their expected complaints.
#include "script/script_files.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "script/check/check_script.h"
#include "script/compile_script.h"

namespace photonloupe::test {

using script::Diagnostic;
using script::Diagnostics;
using script::Place;
using script::Source;

std::vector<std::filesystem::path> list_scripts(const std::string& folder) {
    std::vector<std::filesystem::path> paths;
    const std::filesystem::path root = std::filesystem::path(PHOTONLOUPE_SOURCE_DIR) / "tests/script" / folder;
    for (const auto& entry : std::filesystem::directory_iterator(root))
        if (entry.path().extension() == ".photon")
            paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    return paths;
}

Source read_script(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    Source source{path.filename().string(), {std::istreambuf_iterator<char>(file), {}}};
    constexpr std::string_view PAD = "//! pad ";
    if (source.text.starts_with(PAD))
        source.text.append(std::stoul(source.text.substr(PAD.size())), ' ');
    return source;
}

std::vector<ExpectedDiagnostic> read_expected(const Source& source) {
    std::vector<ExpectedDiagnostic> expected;
    std::uint32_t line_number = 0, code_line = 0;
    const std::uint32_t last = source.find_place(std::uint32_t(source.text.size())).line;
    while (++line_number <= last) {
        const std::string line(source.line_text(line_number));
        if (!line.starts_with("//!")) {
            code_line = line_number;
            continue;
        }
        if (line.starts_with("//! pad "))
            continue;
        ExpectedDiagnostic diagnostic;
        const std::size_t code = line.find_first_of("EW", 3);
        const std::size_t mark = line.find('^');
        if (mark != std::string::npos && mark < code) {
            diagnostic.line = code_line;
            diagnostic.column = std::uint32_t(mark) + 1;
            diagnostic.width = std::uint32_t(line.find_first_not_of('^', mark) - mark);
        }
        diagnostic.code = line.substr(code, 4);
        diagnostic.message = line.substr(code + 5);
        expected.push_back(diagnostic);
    }
    return expected;
}

std::vector<Diagnostic> compile_for_diagnostics(const Source& source) {
    const auto compiled = script::compile_script(source);
    std::vector<Diagnostic> all = compiled->diagnostics;
    for (const script::PhotonLoop& loop : compiled->plan.loops)
        for (const Diagnostic& reason : loop.reasons)
            if (std::none_of(all.begin(), all.end(), [&](const Diagnostic& known) {
                    return known.code == reason.code && known.span.begin == reason.span.begin;
                }))
                all.push_back(reason);
    std::stable_sort(all.begin(), all.end(),
                     [](const Diagnostic& a, const Diagnostic& b) { return a.span.begin < b.span.begin; });
    return all;
}

std::vector<ExpectedDiagnostic> describe_found(const Source& source, const std::vector<Diagnostic>& diagnostics) {
    std::vector<ExpectedDiagnostic> found;
    for (const Diagnostic& diagnostic : diagnostics) {
        const Place begin = source.find_place(diagnostic.span.begin);
        const std::string_view line = source.line_text(begin.line);
        const auto line_end = std::uint32_t(line.data() + line.size() - source.text.data());
        const Place end = source.find_place(std::min(diagnostic.span.end, line_end));
        const std::uint32_t width = end.column > begin.column ? end.column - begin.column : 1;
        found.push_back({begin.line, begin.column, width, diagnostic.code, diagnostic.message});
    }
    return found;
}

std::string to_text(const ExpectedDiagnostic& diagnostic) {
    return std::to_string(diagnostic.line) + ':' + std::to_string(diagnostic.column) + '+' +
           std::to_string(diagnostic.width) + ' ' + diagnostic.code + ' ' + diagnostic.message;
}

script::Program check_accepted(const std::string& text) {
    const Source source{"test.photon", text};
    Diagnostics diagnostics;
    script::Program program = script::check_script(source, diagnostics);
    EXPECT_EQ(script::format_diagnostics(source, diagnostics.sorted()), "");
    return program;
}

std::vector<Diagnostic> find_diagnostics(const std::string& text) {
    Diagnostics diagnostics;
    script::check_script({"test.photon", text}, diagnostics);
    return diagnostics.sorted();
}

std::vector<std::string> find_codes(const std::string& text) {
    std::vector<std::string> codes;
    for (const Diagnostic& diagnostic : find_diagnostics(text))
        codes.push_back(diagnostic.code);
    return codes;
}

} // namespace photonloupe::test
