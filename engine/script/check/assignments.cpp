// SPDX-License-Identifier: Apache-2.0
// Collects assignments over all bodies.
#include "script/check/assignments.h"

namespace photonloupe::script {

std::vector<Assignments> collect_assignments(const Draft& draft) {
    const Program& program = draft.program;
    std::vector<Assignments> all(program.variables.size());
    const auto add = [&](const Expression& expression) {
        if (expression.kind == Expression::Kind::assignment && program.variables[expression.variable].array_size == 0) {
            Assignments& assignments = all[expression.variable];
            assignments.is_changed |= expression.operation != Operator::none;
            assignments.values.push_back(&expression.operands[0]);
        } else if (expression.kind == Expression::Kind::call) {
            const Function& function = program.functions[expression.function];
            for (std::size_t i = 0; i < function.parameters.size(); ++i)
                all[function.parameters[i]].values.push_back(&expression.operands[i]);
        }
    };
    draft.visit_bodies([&](const std::vector<Statement>& body) { visit_expressions(body, add); });
    for (const std::uint32_t exposed : program.exposed)
        all[exposed].is_exposed = true;
    return all;
}

} // namespace photonloupe::script
