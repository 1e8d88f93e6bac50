// SPDX-License-Identifier: Apache-2.0
// Finds the photon loops of a script and plans each.
#include "script/plan/plan.h"

#include "script/plan/plan_loop.h"

namespace photonloupe::script {
namespace {

// Photon loops in uniform code, also in functions that it calls; one inside another is an ordinary loop.
class LoopFinder {
public:
    explicit LoopFinder(const Program& program) : m_program(program) {}

    std::vector<const Statement*> find() {
        visit(m_program.body);
        return std::move(m_found);
    }

private:
    void visit(const Expression& expression) {
        visit_expressions(expression, [&](const Expression& e) {
            if (e.kind == Expression::Kind::call)
                visit(m_program.functions[e.function].body);
        });
    }
    void visit(const std::vector<Expression>& list) {
        for (const Expression& e : list)
            visit(e);
    }
    void visit(const std::vector<Statement>& statements) {
        for (const Statement& s : statements) {
            if (s.kind == Statement::Kind::photon_loop) {
                m_found.push_back(&s);
                continue;
            }
            visit(s.first);
            if (s.value)
                visit(*s.value);
            visit(s.body);
            visit(s.otherwise);
            visit(s.last);
        }
    }

    const Program& m_program;
    std::vector<const Statement*> m_found;
};

// A parameter that its function never assigns stands for what the call gives it.
void find_given(const Program& program, const std::vector<Statement>& body, const BodyAccesses& accesses,
                std::map<std::uint32_t, const Expression*>& given) {
    visit_expressions(body, [&](const Expression& e) {
        if (e.kind != Expression::Kind::call)
            return;
        const Function& function = program.functions[e.function];
        for (std::size_t i = 0; i < function.parameters.size(); ++i)
            if (const auto found = accesses.names.find(function.parameters[i]);
                found != accesses.names.end() && found->second.writes.size() == 1 && found->second.steps.empty())
                given[function.parameters[i]] = &e.operands[i];
        find_given(program, function.body, accesses, given);
    });
}

PhotonLoop plan_loop(LoopFacts& facts, const NameSet& unset, Diagnostics& diagnostics) {
    PhotonLoop loop;
    loop.statement = &facts.statement;
    classify_names(facts, loop);
    for (const auto& [variable, use] : loop.variables)
        if (unset[variable] && facts.program.variables[variable].array_size == 0 &&
            variable != facts.statement.variable)
            loop.unset_reads.insert(variable);
    find_given(facts.program, facts.statement.body, facts.accesses, loop.given);
    classify_calls(facts, loop, diagnostics);
    loop.needs_fuel = facts.accesses.has_unbounded_loop;
    explain_names(facts, loop);
    explain_calls(facts, loop);
    loop.is_parallel = loop.reasons.empty();
    return loop;
}

} // namespace

Plan plan_photon_loops(const Program& program, Diagnostics& diagnostics) {
    const Flow flow = build_flow(program);
    const std::vector<NameSet> live = find_live_names(flow, 0, std::uint32_t(flow.blocks.size()));
    const NameSet unset = find_unset_reads(flow, live);
    Plan plan;
    for (const Statement* statement : LoopFinder(program).find()) {
        const LoopFlow& blocks = flow.loops.at(statement);
        const NameSet enters = find_live_names(flow, blocks.first, blocks.end)[0];
        LoopFacts facts{program, *statement, flow.names, BodyAccesses(), enters, live[blocks.exit]};
        facts.leaves[statement->variable] = false; // it is the photon count then
        plan.loops.push_back(plan_loop(facts, unset, diagnostics));
    }
    return plan;
}

} // namespace photonloupe::script
