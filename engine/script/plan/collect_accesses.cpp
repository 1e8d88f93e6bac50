// SPDX-License-Identifier: Apache-2.0
// Walks a photon loop's body and notes what it does with each name.
#include "script/plan/accesses.h"

#include "script/builtins.h"

namespace photonloupe::script {
namespace {

class Collector {
public:
    Collector(const Program& program, const std::set<const Statement*>& ordinary)
        : m_program(program), m_names(program), m_ordinary(ordinary) {}

    BodyAccesses collect(const Statement& loop) {
        visit(loop.body);
        return std::move(m_found);
    }

private:
    void read(std::uint32_t name, Span span) { m_found.names[name].reads.push_back(span); }
    void write(std::uint32_t name, Span span) { m_found.names[name].writes.push_back(span); }
    void step(std::uint32_t name, Role role, std::uint32_t of, Span span) {
        m_found.names[name].steps.push_back({role, of, span});
    }

    // Statements' expressions, whose values nobody takes.
    void visit_unused(const Expression& e) {
        const std::optional<ReductionStep> found = match_reduction(m_program, e);
        if (!found)
            return visit(e);
        step(found->variable, found->role, 0, e.span);
        if (found->index)
            visit(*found->index);
        if (found->operand)
            visit(*found->operand);
    }

    void visit_choice(const Statement& s, const ChoiceStatement& choice) {
        m_found.choices[&s] = choice;
        step(choice.decided, choice.role, 0, s.value->span);
        visit(*choice.candidate);
        if (choice.index)
            visit(*choice.index);
        for (const Expression* assignment : choice.payload) {
            step(assignment->variable, Role::payload, choice.decided, assignment->span);
            visit(assignment->operands[0]);
        }
    }

    void visit_builtin(const Expression& e) {
        m_found.calls.push_back(&e);
        const auto id = e.builtin->id;
        const std::uint32_t moments = m_names.moments(is_planar(id) ? 2 : 3);
        switch (e.builtin->effect) {
        case Effect::changes_pca:
            if (id == BuiltinId::push_pca_2d || id == BuiltinId::push_pca_3d)
                return step(moments, Role::sum, 0, e.span);
            return write(moments, e.span);
        case Effect::decomposes_pca:
            read(moments, e.span);
            return write(m_names.decomposition(), e.span);
        case Effect::reads_pca:
            return read(m_names.decomposition(), e.span);
        default:
            return;
        }
    }

    void visit(const Expression& e) {
        for (const Expression& operand : e.operands)
            visit(operand);
        switch (e.kind) {
        case Expression::Kind::variable:
        case Expression::Kind::element:
            return read(e.variable, e.span);
        case Expression::Kind::assignment:
            if (e.operation != Operator::none)
                read(e.variable, e.span);
            return write(e.variable, e.span);
        case Expression::Kind::call:
            return visit_call(e);
        case Expression::Kind::builtin:
            return visit_builtin(e);
        default:
            return;
        }
    }

    void visit_call(const Expression& e) {
        const Function& function = m_program.functions[e.function];
        for (std::uint32_t parameter : function.parameters)
            write(parameter, e.span);
        const int depth = m_inner_loops;
        ++m_calls;
        visit(function.body);
        --m_calls;
        m_inner_loops = depth;
    }

    void visit(const std::vector<Statement>& statements) {
        for (const Statement& s : statements)
            visit(s);
    }

    void visit_loop(const Statement& s) {
        m_found.has_unbounded_loop |= !s.is_bounded || s.kind == Statement::Kind::photon_loop;
        for (const Expression& e : s.first)
            visit_unused(e);
        if (s.value)
            visit(*s.value);
        ++m_inner_loops;
        visit(s.body);
        --m_inner_loops;
        for (const Expression& e : s.last)
            visit_unused(e);
        if (s.kind == Statement::Kind::photon_loop)
            write(s.variable, s.span);
    }

    void visit(const Statement& s) {
        switch (s.kind) {
        case Statement::Kind::expression:
            return visit_unused(*s.value);
        case Statement::Kind::declare:
            write(s.variable, s.span);
            if (s.value)
                visit(*s.value);
            return;
        case Statement::Kind::branch:
            if (!m_ordinary.contains(&s))
                if (const std::optional<ChoiceStatement> choice = match_choice(m_program, s))
                    return visit_choice(s, *choice);
            visit(*s.value);
            visit(s.body);
            return visit(s.otherwise);
        case Statement::Kind::loop:
        case Statement::Kind::photon_loop:
            return visit_loop(s);
        case Statement::Kind::block:
            return visit(s.body);
        case Statement::Kind::leave:
            if (m_inner_loops == 0)
                m_found.leaves.push_back(s.span);
            return;
        case Statement::Kind::next:
        case Statement::Kind::expose:
            return;
        case Statement::Kind::give:
            if (s.value)
                visit(*s.value);
            if (m_calls == 0) // of the function that the loop itself stands in
                m_found.leaves.push_back(s.span);
            return;
        }
    }

    const Program& m_program;
    FlowNames m_names;
    const std::set<const Statement*>& m_ordinary;
    BodyAccesses m_found;
    int m_inner_loops = 0, m_calls = 0;
};

} // namespace

BodyAccesses collect_accesses(const Program& program, const Statement& loop,
                              const std::set<const Statement*>& ordinary) {
    return Collector(program, ordinary).collect(loop);
}

} // namespace photonloupe::script
