// SPDX-License-Identifier: Apache-2.0
// Every kind of complaint about a script has one code; this is where each is named and explained.
#pragma once

#include <span>
#include <string_view>

namespace photonloupe::script {

namespace codes {
// The text.
inline constexpr char UNEXPECTED_CHARACTER[] = "E001";
inline constexpr char MALFORMED_NUMBER[] = "E002";
inline constexpr char UNENDED_TEXT[] = "E003";
inline constexpr char UNKNOWN_FUNCTION[] = "E004";
inline constexpr char SYNTAX[] = "E005";
inline constexpr char UNKNOWN_VARIABLE[] = "E006";
inline constexpr char READ_BEFORE_SET[] = "E007";
// Limits.
inline constexpr char TOO_DEEP[] = "E008";
inline constexpr char TOO_LONG[] = "E009";
inline constexpr char TOO_MANY_VARIABLES[] = "E010";
inline constexpr char ARRAY_TOO_LARGE[] = "E011";
inline constexpr char TOO_MANY_ARRAY_NUMBERS[] = "E012";
inline constexpr char TOO_LARGE_INLINED[] = "E013";
// Calls and values.
inline constexpr char ARGUMENT_COUNT[] = "E014";
inline constexpr char ARGUMENT_KIND[] = "E015";
inline constexpr char NOT_ASSIGNABLE[] = "E016";
inline constexpr char FUNCTION_WRITES_SCRIPT[] = "E017";
inline constexpr char RECURSION[] = "E018";
inline constexpr char ARRAY_MISUSE[] = "E019";
inline constexpr char REAL_TO_INTEGER[] = "E020";
inline constexpr char INDEX_OUTSIDE[] = "E021";
inline constexpr char AXIS_OUTSIDE[] = "E022";
inline constexpr char NEGATIVE_ID[] = "E023";
inline constexpr char NOT_WHOLE[] = "E024";
inline constexpr char COUNT_OUTSIDE[] = "E025";
inline constexpr char NOT_UNIFORM[] = "E026";
// Exposed variables and photon parameters.
inline constexpr char BAD_RANGE[] = "E027";
inline constexpr char EXPOSED_INSIDE[] = "E028";
inline constexpr char DECLARED_INSIDE[] = "E029";
inline constexpr char BAD_DIMENSION[] = "E030";
inline constexpr char UNDECLARED_DIMENSION[] = "E031";
// Statements and names.
inline constexpr char JUMP_OUTSIDE[] = "E032";
inline constexpr char NAME_TAKEN[] = "E033";
inline constexpr char NO_VALUE[] = "E034";
inline constexpr char LIST_MISUSE[] = "E035";
inline constexpr char TEXT_MISUSE[] = "E036";
inline constexpr char UNSUPPORTED_OPERATOR[] = "E037";
inline constexpr char NOT_CONSTANT[] = "E038";
// Worth knowing.
inline constexpr char REAL_LOOP_VARIABLE[] = "W010";
// Passes.
inline constexpr char SETS_AND_QUERIES[] = "E070";
inline constexpr char PASS_TOO_LONG[] = "E072";
inline constexpr char KEEPS_VALUE[] = "W070";
inline constexpr char REDUCED_AND_USED[] = "W071";
inline constexpr char LEAVES_LOOP[] = "W072";
inline constexpr char OTHER_PHOTON[] = "W073";
inline constexpr char KEEPS_POINTS[] = "W074";
} // namespace codes

struct DiagnosticCode {
    std::string_view code;
    std::string_view meaning; // one line, for the manual
};

// In order; codes of the checker and of the planner.
std::span<const DiagnosticCode> list_diagnostic_codes();

} // namespace photonloupe::script
