// SPDX-License-Identifier: Apache-2.0
// The script as it is written: names unresolved, nothing typed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "script/read/operators.h"
#include "script/read/tokens.h"

namespace photonloupe::script {

// What may be open at once: parentheses, brackets, operators before their operand, blocks, statements in statements.
constexpr std::uint32_t MAX_NESTING = 64;
// What needs no parentheses still makes a deep tree: a + b + c …; if … else if … else if ….
constexpr std::uint32_t MAX_CHAIN = 256;

struct SyntaxExpression {
    enum class Kind : std::uint8_t {
        number,      // `token`
        text,        // `token`
        name,        // `name`
        index,       // name[operand]
        call,        // name(operands)
        unary,       // operation: none (+), negate, logical_not
        binary,      // operation
        conditional, // condition, then, else
        assignment,  // target, value; operation of a compound one; ++ and -- have the value 1
    };
    Kind kind = Kind::number;
    Span span;
    Span name_span;
    std::string name;
    Token token;
    Operator operation = Operator::none;
    bool is_step = false; // ++ or --
    bool is_postfix = false;
    std::uint32_t depth = 1; // of the tree below, this node included; at most MAX_CHAIN
    std::vector<SyntaxExpression> operands;
};

enum class WrittenType : std::uint8_t { none, real, integer }; // nothing (or `function`), float, int

// One name of a declaration, or one parameter of a function.
struct Declarator {
    std::string name;
    Span span;
    WrittenType type = WrittenType::none;
    std::optional<SyntaxExpression> size, value;
};

struct SignedNumber {
    double value = 0;
    bool is_integer = false;
    Span span;
};

struct SyntaxStatement {
    enum class Kind : std::uint8_t {
        expression,
        declare,
        branch,
        for_loop,
        while_loop,
        do_loop,
        leave,
        next,
        give,
        block,
        expose,
        nothing,
    };
    Kind kind = Kind::nothing;
    Span span;                                 // of the head
    std::vector<Declarator> declarators;       // declare; a for loop that declares its variable
    std::vector<SyntaxExpression> first, last; // of a for loop
    std::optional<SyntaxExpression> value;     // expression, condition, returned value
    std::vector<SyntaxStatement> body, otherwise;
    std::string name; // expose
    Span name_span;
    SignedNumber low, high;
    std::optional<SignedNumber> step;
};

struct SyntaxFunction {
    std::string name;
    Span span; // of the name
    WrittenType result = WrittenType::none;
    std::vector<Declarator> parameters;
    std::vector<SyntaxStatement> body;
};

struct SyntaxScript {
    std::vector<SyntaxStatement> body;
    std::vector<SyntaxFunction> functions;
    bool is_complete = true; // false: parts are missing, since they could not be read
};

// Reports every syntax error it finds and returns what could be read.
SyntaxScript parse_script(const Source& source, Diagnostics& diagnostics);

} // namespace photonloupe::script
