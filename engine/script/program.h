// SPDX-License-Identifier: Apache-2.0
// The checked script: every name resolved, every expression typed. Planner, emitter and interpreter read this tree.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "script/read/operators.h"
#include "script/read/source.h"

namespace photonloupe::script {

struct Builtin;

enum class Type : std::uint8_t { none, integer, real, list, text }; // truth values are the integers 0 and 1

// Photon columns a script can read; bits of a set.
enum Columns : std::uint32_t {
    COLUMN_POSITION = 1,
    COLUMN_NORMAL = 2,
    COLUMN_POWER = 4,
    COLUMN_EMITTER = 8,
    COLUMN_PARAMETERS = 16,
    COLUMN_PATH_STARTS = 32,
    COLUMN_PATH_VERTICES = 64,
    COLUMN_PATH_NORMALS = 128,
    COLUMN_PATH_INTERACTIONS = 256,
    COLUMN_PATH_OBJECTS = 512,
    COLUMN_PATH_SCATTER = 1024,
};

struct Exposure {
    double low = 0, high = 0, step = 0; // step 0: none was given
    bool is_integer = false;            // low, high and an explicit step are integers
    Span span;
};

struct Variable {
    std::string name;
    Type type = Type::real;
    std::uint32_t array_size = 0;    // 0: a scalar (or a list)
    bool is_local = false;           // declared in a block or a function; else script-wide
    Span span;                       // where it is first assigned or declared
    std::optional<double> constant;  // every assignment gives it this one value, known now (X = 0; GAMMA = 3)
    bool holds_photon_count = false; // every assignment gives it getNumPhotons()
    std::optional<Exposure> exposed;
    std::optional<double> default_value; // of an exposed variable: what it holds where it is exposed
};

// A scalar's or array element's number, a call, an assignment …; children in `operands`.
struct Expression {
    enum class Kind : std::uint8_t {
        number,      // `integer` or `real`, by type
        text,        // `label`: a string literal
        variable,    // a scalar or a list; `variable`
        element,     // of an array; operands: index
        list_item,   // operands: list, index
        list_length, // operands: list
        convert,     // integer → real; operands: one
        unary,       // operation negate, logical_not; operands: one
        binary,      // operation; operands: two of one type (&& and || take any)
        conditional, // operands: condition, then, else (both of the expression's type)
        builtin,     // `builtin`; operands: the arguments as written (left-out ones are absent)
        call,        // `function`; operands: its arguments, converted to the parameters' types
        assignment,  // `variable`; operands: value, then the index if it is an array's element. See `operation`,
                     // `is_postfix` (evaluated in this order: index, value, old value of a compound assignment)
    };
    Kind kind = Kind::number;
    Type type = Type::none;
    Span span;
    std::int32_t integer = 0;
    float real = 0;
    std::string label;
    std::uint32_t variable = 0;          // index into Program::variables
    Operator operation = Operator::none; // of an assignment: none is =, add is += and ++, …
    bool is_postfix = false;             // x++ and x--: its value is the old one
    bool may_be_unset = false; // a read (a compound assignment reads too) that some path reaches before a value
    const Builtin* builtin = nullptr;
    std::uint32_t function = 0; // index into Program::functions
    std::vector<Expression> operands;
};

struct Statement {
    enum class Kind : std::uint8_t {
        expression,  // `value`
        declare,     // `variable` becomes unset (an array: zero); `value`, if there is one, is its first assignment
        branch,      // if (value) body else otherwise
        loop,        // first; while (value) { body; last }, `value` absent: for ever; test_last: do … while
        photon_loop, // `variable` runs over all photons in steps of one; body
        block,       // body
        leave,       // break
        next,        // continue
        give,        // return `value`, of a function
        expose,      // `variable` takes the value the run gives it, if it gives one (uniform code only)
    };
    Kind kind = Kind::expression;
    Span span; // of the statement's head (for a loop: to its closing parenthesis)
    std::uint32_t variable = 0;
    std::optional<Expression> value;
    std::vector<Expression> first, last; // of a for loop
    std::vector<Statement> body, otherwise;
    bool test_last = false;
    bool is_bounded =
        false; // a provable bound on its turns (constants, path vertices, neighbour counts): needs no fuel
};

// One call's copy of a function (functions are inlined: each call site has variables of its own).
struct Function {
    std::string name;
    Type result = Type::none;
    std::vector<std::uint32_t> parameters; // variables
    std::vector<Statement> body;
    Span span;                          // of its definition's head
    bool may_end_without_value = false; // then the call's value is NaN (integer: 0) and reported
};

// What X, Y, Z and E hold before a script assigns them.
constexpr double PREDEFINED_VALUES[] = {0, 1, 2, 2.718281828459045};

struct Program {
    Source source;
    std::vector<Variable> variables; // X, Y, Z, E first
    std::vector<Function> functions;
    std::vector<Statement> body;        // uniform code and photon loops, in order
    std::vector<std::uint32_t> exposed; // variables, in the order written
    std::uint32_t columns = 0;          // all it reads
};

// The same for every node of the tree: `visit(expression)` before its operands; functions' bodies are not entered.
template <class Visit>
void visit_expressions(const Expression& expression, Visit&& visit) {
    visit(expression);
    for (const Expression& operand : expression.operands) {
        visit_expressions(operand, visit);
    }
}

template <class Visit>
void visit_expressions(const std::vector<Statement>& statements, Visit&& visit) {
    for (const Statement& statement : statements) {
        for (const Expression& expression : statement.first) {
            visit_expressions(expression, visit);
        }
        if (statement.value) {
            visit_expressions(*statement.value, visit);
        }
        visit_expressions(statement.body, visit);
        visit_expressions(statement.otherwise, visit);
        for (const Expression& expression : statement.last) {
            visit_expressions(expression, visit);
        }
    }
}

} // namespace photonloupe::script
