// SPDX-License-Identifier: Apache-2.0
// Sizes of arrays, and what one photon's arrays may hold together.
#include <cmath>

#include "script/check/check_stages.h"
#include "script/check/evaluate_constant.h"
#include "script/check/format_number.h"
#include "script/check/walk_calls.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

constexpr std::uint32_t MAX_ARRAY = 4096;
constexpr std::uint32_t MAX_PHOTON_NUMBERS = 512;

std::uint32_t find_array_size(const Program& program, const PendingSize& pending, Diagnostics& diagnostics) {
    const std::string& name = program.variables[pending.variable].name;
    const std::optional<double> size = evaluate_constant(program, pending.size);
    if (is_unknown(pending.size))
        return 1;
    if (!size) {
        diagnostics.add(codes::NOT_CONSTANT, pending.size.span,
                        "the size of '" + name + "' is not known when the script is compiled",
                        "a number, or a variable that only ever holds one number");
    } else if (*size != std::floor(*size) || !std::isfinite(*size)) {
        diagnostics.add(codes::NOT_WHOLE, pending.size.span,
                        "an array's size must be a whole number, not " + format_number(*size));
    } else if (*size < 1 || *size > MAX_ARRAY) {
        diagnostics.add(codes::ARRAY_TOO_LARGE, pending.size.span,
                        "'" + name + "' would hold " + format_number(*size) + " numbers, 1 to 4096 are accepted");
    } else {
        return std::uint32_t(*size);
    }
    return MAX_ARRAY; // so that indices are not refused on top
}

} // namespace

void resolve_array_sizes(Draft& draft, Diagnostics& diagnostics) {
    for (const PendingSize& pending : draft.sizes)
        draft.program.variables[pending.variable].array_size = find_array_size(draft.program, pending, diagnostics);
}

void check_photon_arrays(const Draft& draft, Diagnostics& diagnostics) {
    std::uint32_t numbers = 0;
    walk_calls(draft.program, [&](const Statement& statement, const Statement* photon_loop) {
        if (statement.kind == Statement::Kind::photon_loop && !photon_loop)
            numbers = 0;
        if (statement.kind != Statement::Kind::declare || !photon_loop)
            return;
        const std::uint32_t size = draft.program.variables[statement.variable].array_size;
        if (numbers <= MAX_PHOTON_NUMBERS && numbers + size > MAX_PHOTON_NUMBERS)
            diagnostics.add(codes::TOO_MANY_ARRAY_NUMBERS, statement.span,
                            "the arrays declared in this photon loop hold more than 512 numbers",
                            "declare the array before the loop if all photons may share it");
        numbers = std::min(numbers + size, MAX_PHOTON_NUMBERS + 1);
    });
}

} // namespace photonloupe::script
