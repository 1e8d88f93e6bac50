// SPDX-License-Identifier: Apache-2.0
// What is wrong with a script, as values: the studio's markers, Python's lists, the terminal's text, JSON.
#pragma once

#include <string>
#include <unordered_set>
#include <vector>

#include "core/error.h"
#include "script/read/source.h"

namespace photonloupe::script {

enum class Severity : std::uint8_t { error, warning };

// Each kind of complaint has one code, listed in diagnostic_codes.h.
struct Diagnostic {
    std::string code; // "E004", "W001"
    Severity severity = Severity::error;
    Span span;
    std::string message; // one sentence
    std::string note;    // may be empty: "did you mean …", how to rewrite it
};

// Collects each complaint once; hands out the first MAX_ERRORS errors and all warnings in source order.
class Diagnostics {
public:
    static constexpr std::size_t MAX_ERRORS = 20;
    void add(std::string code, Span span, std::string message, std::string note = {});
    bool has_errors() const;
    const std::vector<Diagnostic>& all() const { return m_list; } // as they were found
    std::vector<Diagnostic> sorted() const;

private:
    std::vector<Diagnostic> m_list;
    std::unordered_set<std::string> m_known; // code, span and message of each
};

//     tortuosity.photon:25:8: error E004: unknown function 'getPathVertx'
//       x0 = getPathVertx(i, j, X) - getPathVertex(i, j-1, X);
//            ^^^^^^^^^^^^ did you mean 'getPathVertex(photon, vertex, axis)'?
std::string format_diagnostic(const Source& source, const Diagnostic& diagnostic);
std::string format_diagnostics(const Source& source, const std::vector<Diagnostic>& diagnostics);

// The script cannot run; what() is the formatted text.
class ScriptError : public Error {
public:
    ScriptError(const Source& source, std::vector<Diagnostic> diagnostics);
    const std::vector<Diagnostic>& diagnostics() const { return m_diagnostics; }

private:
    std::vector<Diagnostic> m_diagnostics;
};

} // namespace photonloupe::script
