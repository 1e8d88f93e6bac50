// SPDX-License-Identifier: Apache-2.0
// Recognizes the statements that reduce: sums, least and greatest by call, and choices by `if`.
#include "script/plan/accesses.h"

#include "script/builtins.h"

namespace photonloupe::script {
namespace {

bool changes_something(const Program& program, const std::vector<Statement>& body);

// Assignments to a function's own names stay in it.
bool changes_something(const Program& program, const Expression& e, bool in_function) {
    bool found = false;
    visit_expressions(e, [&](const Expression& part) {
        if (part.kind == Expression::Kind::assignment)
            found |= !in_function;
        else if (part.kind == Expression::Kind::call)
            found |= changes_something(program, program.functions[part.function].body);
        else if (part.kind == Expression::Kind::builtin)
            found |= part.builtin->effect != Effect::none && part.builtin->effect != Effect::reads_photon &&
                     part.builtin->effect != Effect::queries && part.builtin->effect != Effect::reads_pca;
    });
    return found;
}

bool changes_something(const Program& program, const std::vector<Statement>& body) {
    bool found = false;
    visit_expressions(body, [&](const Expression& part) {
        if (part.kind == Expression::Kind::builtin || part.kind == Expression::Kind::call)
            found |= changes_something(program, part, true);
    });
    return found;
}

bool are_same_calls(const Program& program, const Expression& a, const Expression& b) {
    const Function &f = program.functions[a.function], &g = program.functions[b.function];
    if (f.span.begin != g.span.begin || f.parameters.size() != g.parameters.size())
        return false;
    for (std::size_t i = 0; i < f.parameters.size(); ++i)
        if (program.variables[f.parameters[i]].type != program.variables[g.parameters[i]].type)
            return false;
    return true;
}

// The expression itself, or inside a conversion to float.
const Expression& strip(const Expression& e) {
    return e.kind == Expression::Kind::convert ? e.operands[0] : e;
}

// Where an assignment's target is named again in its own value, or in a comparison.
bool is_target(const Program& program, const Expression& e, std::uint32_t variable, const Expression* index) {
    if (e.variable != variable)
        return false;
    if (!index)
        return e.kind == Expression::Kind::variable;
    return e.kind == Expression::Kind::element && are_same(program, e.operands[0], *index);
}

const Expression* find_index(const Expression& assignment) {
    return assignment.operands.size() > 1 ? &assignment.operands[1] : nullptr;
}

// What is combined with the target in `s = s + e`, `s = min(e, s)` …
const Expression* find_other(const Program& program, const Expression& assignment, const Expression& value,
                             bool commutes = true) {
    if (value.operands.size() != 2)
        return nullptr;
    const Expression* index = find_index(assignment);
    if (is_target(program, value.operands[0], assignment.variable, index))
        return &value.operands[1];
    if (commutes && is_target(program, value.operands[1], assignment.variable, index))
        return &value.operands[0];
    return nullptr;
}

// A written-out step evaluates the index twice: nothing may change between.
bool is_written_out_safely(const Program& program, const Expression& assignment) {
    return !find_index(assignment) || !has_side_effects(program, assignment.operands[0]);
}

std::optional<ReductionStep> match_written_out(const Program& program, const Expression& e) {
    ReductionStep step{Role::sum, e.variable, nullptr, find_index(e)};
    const Expression& value = e.operands[0];
    if (value.kind == Expression::Kind::binary && value.operation == Operator::add) {
        step.operand = find_other(program, e, value);
    } else if (value.kind == Expression::Kind::binary && value.operation == Operator::subtract) {
        step.operand = find_other(program, e, value, false);
        step.is_negated = true;
    } else if (value.kind == Expression::Kind::builtin &&
               (value.builtin->id == BuiltinId::min || value.builtin->id == BuiltinId::max)) {
        step.operand = find_other(program, e, value);
        step.role = value.builtin->id == BuiltinId::min ? Role::minimum : Role::maximum;
    }
    if (!step.operand || !is_written_out_safely(program, e))
        return std::nullopt;
    return step;
}

// The assignments of a choice's body, if it holds nothing else.
bool list_assignments(const std::vector<Statement>& body, std::vector<const Expression*>& assignments) {
    for (const Statement& s : body) {
        if (s.kind == Statement::Kind::block) {
            if (!list_assignments(s.body, assignments))
                return false;
        } else if (s.kind == Statement::Kind::expression && s.value->kind == Expression::Kind::assignment &&
                   s.value->operation == Operator::none) {
            assignments.push_back(&*s.value);
        } else {
            return false;
        }
    }
    return true;
}

// Sorts a choice's assignments into the one that is decided and its payload.
bool fill_choice(const Program& program, const std::vector<const Expression*>& assignments, const Expression& target,
                 const Expression& candidate, ChoiceStatement& choice) {
    choice.decided = target.variable;
    choice.candidate = &candidate;
    choice.index = target.kind == Expression::Kind::element ? &target.operands[0] : nullptr;
    const std::uint32_t size = program.variables[target.variable].array_size;
    for (const Expression* assignment : assignments) {
        const Expression* index = find_index(*assignment);
        const bool is_alike = bool(index) == bool(choice.index) && (!index || are_same(program, *index, *choice.index));
        if (!is_alike || program.variables[assignment->variable].array_size != size ||
            has_side_effects(program, assignment->operands[0]))
            return false;
        if (assignment->variable != choice.decided)
            choice.payload.push_back(assignment);
        else if (choice.decision || !are_same(program, strip(assignment->operands[0]), strip(candidate)))
            return false;
        else
            choice.decision = assignment;
    }
    return choice.decision != nullptr;
}

} // namespace

bool has_side_effects(const Program& program, const Expression& expression) {
    return changes_something(program, expression, false);
}

bool are_same(const Program& program, const Expression& a, const Expression& b) {
    if (a.kind != b.kind || a.type != b.type || a.kind == Expression::Kind::assignment ||
        a.operands.size() != b.operands.size() || a.operation != b.operation || a.builtin != b.builtin)
        return false;
    const bool is_number = a.kind == Expression::Kind::number;
    if (is_number && (a.type == Type::integer ? a.integer != b.integer : !(a.real == b.real)))
        return false;
    if (a.kind == Expression::Kind::call) {
        if (!are_same_calls(program, a, b))
            return false;
    } else if (a.variable != b.variable) {
        return false;
    }
    if (has_side_effects(program, a))
        return false;
    for (std::size_t i = 0; i < a.operands.size(); ++i)
        if (!are_same(program, a.operands[i], b.operands[i]))
            return false;
    return true;
}

std::optional<ReductionStep> match_reduction(const Program& program, const Expression& e) {
    if (e.kind != Expression::Kind::assignment || program.variables[e.variable].type == Type::list)
        return std::nullopt;
    switch (e.operation) {
    case Operator::add:
    case Operator::subtract:
        return ReductionStep{Role::sum, e.variable, &e.operands[0], find_index(e), e.operation == Operator::subtract};
    case Operator::none:
        return match_written_out(program, e);
    default:
        return std::nullopt;
    }
}

std::optional<ChoiceStatement> match_choice(const Program& program, const Statement& statement) {
    if (statement.kind != Statement::Kind::branch || !statement.otherwise.empty())
        return std::nullopt;
    const Expression& condition = *statement.value;
    if (condition.kind != Expression::Kind::binary ||
        (condition.operation != Operator::less && condition.operation != Operator::greater))
        return std::nullopt;
    std::vector<const Expression*> assignments;
    if (!list_assignments(statement.body, assignments))
        return std::nullopt;
    for (const int side : {1, 0}) {
        const Expression &target = condition.operands[side], &candidate = condition.operands[1 - side];
        if (target.kind != Expression::Kind::variable && target.kind != Expression::Kind::element)
            continue;
        ChoiceStatement choice;
        choice.role = (condition.operation == Operator::less) == (side == 1) ? Role::least : Role::greatest;
        if (!has_side_effects(program, candidate) && fill_choice(program, assignments, target, candidate, choice))
            return choice;
    }
    return std::nullopt;
}

} // namespace photonloupe::script
