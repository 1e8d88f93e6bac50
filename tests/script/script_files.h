// SPDX-License-Identifier: Apache-2.0
// The test scripts: files to accept, and files to reject with the expected complaints under the offending characters.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "script/program.h"
#include "script/read/diagnostics.h"

namespace photonloupe::test {

std::vector<std::filesystem::path> list_scripts(const std::string& folder); // of tests/script, sorted
script::Source read_script(const std::filesystem::path& path);

// A line "//!    ^^^^ E004 unknown function …" below the line it is about: the marks stand under the span, the message
// is the whole message, or its beginning and "...". Without marks the place does not matter. "//! pad N" appends N
// blanks to the text.
struct ExpectedDiagnostic {
    std::uint32_t line = 0, column = 0, width = 0; // column 0: anywhere
    std::string code, message;
    bool operator==(const ExpectedDiagnostic&) const = default;
};
std::vector<ExpectedDiagnostic> read_expected(const script::Source& source);

// All complaints about a script, and why loops of it are serial.
std::vector<script::Diagnostic> compile_for_diagnostics(const script::Source& source);

// What was found, in the same form.
std::vector<ExpectedDiagnostic> describe_found(const script::Source& source,
                                               const std::vector<script::Diagnostic>& diagnostics);
std::string to_text(const ExpectedDiagnostic& diagnostic);

// Checks a script and fails the test if anything is wrong with it.
script::Program check_accepted(const std::string& text);
// The codes of what is wrong with a script, in source order.
std::vector<std::string> find_codes(const std::string& text);
std::vector<script::Diagnostic> find_diagnostics(const std::string& text);

} // namespace photonloupe::test
