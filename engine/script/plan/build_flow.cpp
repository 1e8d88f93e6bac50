// SPDX-License-Identifier: Apache-2.0
// Cuts a script into blocks without branches, in the order in which its expressions are evaluated.
#include "script/plan/flow.h"

#include <algorithm>

#include "script/builtins.h"

namespace photonloupe::script {
namespace {

class Builder {
public:
    explicit Builder(const Program& program) : m_program(program), m_flow{FlowNames(program), {}, {}} {
        m_here = add_block();
    }

    Flow build() {
        visit(m_program.body);
        return std::move(m_flow);
    }

private:
    using Access = FlowAccess::Kind;

    std::uint32_t add_block() {
        m_flow.blocks.emplace_back();
        return std::uint32_t(m_flow.blocks.size() - 1);
    }
    void link(std::uint32_t from, std::uint32_t to) { m_flow.blocks[from].next.push_back(to); }
    void note(Access kind, std::uint32_t name) { m_flow.blocks[m_here].accesses.push_back({kind, name}); }
    std::uint32_t start_block() { // after the present one
        const std::uint32_t block = add_block();
        link(m_here, block);
        return m_here = block;
    }

    void visit_assignment(const Expression& e) {
        if (e.operation != Operator::none)
            note(Access::read, e.variable);
        for (const Expression& operand : e.operands)
            visit(operand);
        if (m_program.variables[e.variable].array_size == 0)
            note(Access::write, e.variable);
    }

    // The second operand of && and ||, either branch of ?: may be left out.
    void visit_choice(const Expression& e) {
        visit(e.operands[0]);
        const std::uint32_t start = m_here, join = add_block();
        for (std::size_t i = 1; i < e.operands.size(); ++i) {
            m_here = start;
            start_block();
            visit(e.operands[i]);
            link(m_here, join);
        }
        if (e.kind == Expression::Kind::binary)
            link(start, join);
        m_here = join;
    }

    void visit_call(const Expression& e) {
        const Function& function = m_program.functions[e.function];
        for (const Expression& operand : e.operands)
            visit(operand);
        for (std::uint32_t name : list_own_variables(m_program, function))
            note(Access::forget, name);
        for (std::uint32_t parameter : function.parameters)
            note(Access::write, parameter);
        m_returns.push_back(add_block());
        visit(function.body);
        link(m_here, m_returns.back());
        m_here = m_returns.back();
        m_returns.pop_back();
    }

    void visit_builtin(const Expression& e) {
        for (const Expression& operand : e.operands)
            visit(operand);
        const FlowNames& names = m_flow.names;
        const auto moments = names.moments(is_planar(e.builtin->id) ? 2 : 3);
        switch (e.builtin->id) {
        case BuiltinId::reset_pca_2d:
        case BuiltinId::reset_pca_3d:
            return note(Access::write, moments);
        case BuiltinId::push_pca_2d:
        case BuiltinId::push_pca_3d:
            return note(Access::read, moments);
        case BuiltinId::decompose_pca_2d:
        case BuiltinId::decompose_pca_3d:
            note(Access::read, moments);
            return note(Access::write, names.decomposition());
        case BuiltinId::get_pca_eigenvalue:
        case BuiltinId::get_pca_eigenvector:
        case BuiltinId::get_pca_mean:
            return note(Access::read, names.decomposition());
        default:
            return;
        }
    }

    void visit(const Expression& e) {
        switch (e.kind) {
        case Expression::Kind::variable:
            return note(Access::read, e.variable);
        case Expression::Kind::assignment:
            return visit_assignment(e);
        case Expression::Kind::conditional:
            return visit_choice(e);
        case Expression::Kind::call:
            return visit_call(e);
        case Expression::Kind::builtin:
            return visit_builtin(e);
        case Expression::Kind::binary:
            if (e.operation == Operator::logical_and || e.operation == Operator::logical_or)
                return visit_choice(e);
            break;
        default:
            break;
        }
        for (const Expression& operand : e.operands)
            visit(operand);
        if (e.kind == Expression::Kind::element)
            note(Access::read, e.variable);
    }

    void visit(const std::vector<Expression>& list) {
        for (const Expression& e : list)
            visit(e);
    }
    void visit(const std::vector<Statement>& statements) {
        for (const Statement& statement : statements)
            visit(statement);
    }

    void visit_branch(const Statement& s) {
        visit(*s.value);
        const std::uint32_t start = m_here, join = add_block();
        for (const auto* side : {&s.body, &s.otherwise}) {
            m_here = start;
            start_block();
            visit(*side);
            link(m_here, join);
        }
        m_here = join;
    }

    void visit_loop(const Statement& s) {
        visit(s.first);
        const std::uint32_t exit = add_block(), again = add_block();
        const std::uint32_t head = start_block();
        std::uint32_t body = head;
        if (!s.test_last) {
            if (s.value) {
                visit(*s.value);
                link(m_here, exit);
            }
            body = start_block();
        }
        visit_body(s, exit, again);
        link(m_here, again);
        m_here = again;
        visit(s.last);
        if (s.test_last && s.value) {
            visit(*s.value);
            link(m_here, exit);
        }
        link(m_here, s.test_last ? body : head);
        m_here = exit;
    }

    void visit_photon_loop(const Statement& s) {
        const std::uint32_t exit = add_block(), again = add_block(), head = start_block();
        note(Access::write, s.variable);
        link(head, exit);
        const std::uint32_t first = start_block();
        visit_body(s, exit, again);
        link(m_here, again);
        m_flow.loops[&s] = {first, std::uint32_t(m_flow.blocks.size()), exit};
        link(again, head);
        m_here = exit;
    }

    void visit_body(const Statement& s, std::uint32_t exit, std::uint32_t again) {
        m_exits.push_back({exit, again});
        visit(s.body);
        m_exits.pop_back();
    }

    void jump(std::uint32_t target) {
        link(m_here, target);
        m_here = add_block(); // what follows is never reached
    }

    void visit(const Statement& s) {
        switch (s.kind) {
        case Statement::Kind::expression:
            return visit(*s.value);
        case Statement::Kind::declare:
            note(Access::forget, s.variable);
            if (s.value)
                visit(*s.value);
            return;
        case Statement::Kind::branch:
            return visit_branch(s);
        case Statement::Kind::loop:
            return visit_loop(s);
        case Statement::Kind::photon_loop:
            return visit_photon_loop(s);
        case Statement::Kind::expose:
            return;
        case Statement::Kind::block:
            return visit(s.body);
        case Statement::Kind::leave:
            return jump(m_exits.back().exit);
        case Statement::Kind::next:
            return jump(m_exits.back().again);
        case Statement::Kind::give:
            if (s.value)
                visit(*s.value);
            return jump(m_returns.back());
        }
    }

    struct Exits {
        std::uint32_t exit, again;
    };
    const Program& m_program;
    Flow m_flow;
    std::uint32_t m_here = 0;
    std::vector<Exits> m_exits;
    std::vector<std::uint32_t> m_returns;
};

} // namespace

Flow build_flow(const Program& program) {
    return Builder(program).build();
}

std::vector<std::uint32_t> list_own_variables(const Program& program, const Function& function) {
    std::vector<std::uint32_t> own = function.parameters;
    const auto add = [&](std::uint32_t variable) {
        if (program.variables[variable].is_local && std::find(own.begin(), own.end(), variable) == own.end())
            own.push_back(variable);
    };
    visit_expressions(function.body, [&](const Expression& e) {
        if (e.kind == Expression::Kind::variable || e.kind == Expression::Kind::element ||
            e.kind == Expression::Kind::assignment)
            add(e.variable);
    });
    return own;
}

} // namespace photonloupe::script
