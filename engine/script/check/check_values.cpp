// SPDX-License-Identifier: Apache-2.0
// Ranges of constant arguments and indices.
#include "script/check/check_stages.h"

#include <cmath>

#include "photons/search_space.h"
#include "script/builtins.h"
#include "script/check/evaluate_constant.h"
#include "script/check/format_number.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

using Kind = Expression::Kind;

struct Bounds {
    const char* code = nullptr;
    const char* what = nullptr;
    double low = 0, high = HUGE_VAL;
};

// Nothing for arguments that may be any number.
std::optional<Bounds> find_bounds(const Builtin& builtin, Argument argument) {
    switch (argument) {
    case Argument::photon:
        return Bounds{codes::NEGATIVE_ID, "a photon", 0, HUGE_VAL};
    case Argument::vertex:
        return Bounds{codes::NEGATIVE_ID, "a vertex", 0, HUGE_VAL};
    case Argument::axis:
        return Bounds{codes::AXIS_OUTSIDE, "an axis", 0, 2};
    case Argument::channel:
        return Bounds{codes::AXIS_OUTSIDE, "a channel", 0, 2};
    case Argument::dimension:
        return builtin.effect == Effect::reads_photon ? Bounds{codes::BAD_DIMENSION, "a dimension", 0, 15}
                                                      : Bounds{codes::BAD_DIMENSION, "a parameter's dimension", 3, 15};
    case Argument::uniform_count:
        return Bounds{codes::COUNT_OUTSIDE, "a number of neighbors", 1, MOST_NEIGHBORS};
    case Argument::bin_count:
        return Bounds{codes::COUNT_OUTSIDE, "a number of bins", 1, 4096};
    case Argument::item:
        return Bounds{nullptr, "this argument", -HUGE_VAL, HUGE_VAL};
    default:
        return std::nullopt;
    }
}

class ValueChecker {
public:
    ValueChecker(const Program& program, Diagnostics& diagnostics) : m_program(program), m_diagnostics(diagnostics) {}

    void check(const Expression& expression) {
        if (expression.kind == Kind::element || expression.kind == Kind::list_item)
            check_index(expression, expression.operands.back());
        else if (expression.kind == Kind::assignment && expression.operands.size() > 1)
            check_index(expression, expression.operands[1]);
        else if (expression.kind == Kind::builtin)
            check_call(expression);
    }

private:
    void check_index(const Expression& expression, const Expression& index) {
        const bool is_list = expression.kind == Kind::list_item;
        const std::uint32_t variable = is_list ? expression.operands[0].variable : expression.variable;
        const double size = is_list ? MOST_NEIGHBORS : m_program.variables[variable].array_size;
        const std::optional<double> value = evaluate_constant(m_program, index);
        if (!value || !check_whole(*value, index.span, "an index"))
            return;
        if (*value >= 0 && *value < size)
            return;
        const std::string name = "'" + m_program.variables[variable].name + "'";
        m_diagnostics.add(codes::INDEX_OUTSIDE, index.span,
                          "index " + format_number(*value) + " is outside " +
                              (is_list ? "the neighbor list " : "the array ") + name,
                          "indices run from 0 to " + format_number(size - 1));
    }

    bool check_whole(double value, Span span, const char* what) {
        if (value == std::floor(value) && std::isfinite(value))
            return true;
        m_diagnostics.add(codes::NOT_WHOLE, span,
                          std::string(what) + " must be a whole number, not " + format_number(value));
        return false;
    }

    void check_call(const Expression& call) {
        const Builtin& builtin = *call.builtin;
        for (std::size_t i = 0; i < call.operands.size() && i < builtin.arguments.size(); ++i) {
            const std::optional<Bounds> bounds = find_bounds(builtin, builtin.arguments[i]);
            const std::optional<double> value = bounds ? evaluate_constant(m_program, call.operands[i]) : std::nullopt;
            if (value && check_whole(*value, call.operands[i].span, bounds->what))
                check_bounds(call, *bounds, *value, call.operands[i].span);
        }
        if (builtin.id == BuiltinId::histogram || builtin.id == BuiltinId::declare_photon_parameter)
            check_order(call);
    }

    void check_bounds(const Expression& call, const Bounds& bounds, double value, Span span) {
        if (value >= bounds.low && value <= bounds.high)
            return;
        const bool sets_position = bounds.low == 3 && value >= 0 && value < 3;
        const std::string range = bounds.high == HUGE_VAL
                                      ? "starts at 0"
                                      : "is " + format_number(bounds.low) + " to " + format_number(bounds.high);
        m_diagnostics.add(bounds.code, span, std::string(bounds.what) + " " + range + ", not " + format_number(value),
                          sets_position ? "dimensions 0-2 are the position, which can't be set"
                                        : std::string(call.builtin->signature));
    }

    // lo < hi of a histogram or parameter.
    void check_order(const Expression& call) {
        const std::size_t first = call.builtin->id == BuiltinId::histogram ? 2 : 1;
        const std::optional<double> low = evaluate_constant(m_program, call.operands[first]);
        const std::optional<double> high = evaluate_constant(m_program, call.operands[first + 1]);
        const bool is_ordered = !low || !high || (*low < *high && std::isfinite(*low) && std::isfinite(*high));
        if (!is_ordered)
            m_diagnostics.add(codes::BAD_RANGE, {call.operands[first].span.begin, call.operands[first + 1].span.end},
                              "the lower bound must be below the upper, both finite",
                              std::string(call.builtin->signature));
    }

    const Program& m_program;
    Diagnostics& m_diagnostics;
};

} // namespace

void check_values(const Draft& draft, Diagnostics& diagnostics) {
    ValueChecker checker(draft.program, diagnostics);
    draft.visit_bodies([&](const std::vector<Statement>& body) {
        visit_expressions(body, [&](const Expression& expression) { checker.check(expression); });
    });
}

} // namespace photonloupe::script
