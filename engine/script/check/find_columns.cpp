// SPDX-License-Identifier: Apache-2.0
// Collects columns over the typed tree.
#include "script/check/check_stages.h"

#include "script/builtins.h"
#include "script/check/evaluate_constant.h"

namespace photonloupe::script {

std::uint32_t find_columns(const Program& program, const Expression& call) {
    if (call.kind != Expression::Kind::builtin)
        return 0;
    if (call.builtin->id != BuiltinId::get_photon_parameter)
        return call.builtin->columns;
    const std::optional<double> dimension = evaluate_constant(program, call.operands[1]);
    if (!dimension)
        return COLUMN_PARAMETERS | COLUMN_POSITION;
    return *dimension < 3 ? COLUMN_POSITION : COLUMN_PARAMETERS;
}

std::uint32_t find_columns(const Program& program) {
    std::uint32_t columns = 0;
    const auto add = [&](const Expression& expression) { columns |= find_columns(program, expression); };
    visit_expressions(program.body, add);
    for (const Function& function : program.functions)
        visit_expressions(function.body, add);
    return columns;
}

} // namespace photonloupe::script
