// SPDX-License-Identifier: Apache-2.0
// Expressions as GLSL: names, operators, order of evaluation.
#include <algorithm>
#include <cmath>

#include "script/emit/emitter.h"
#include "script/emit/glsl_numbers.h"

namespace photonloupe::script {
std::string wrap(const Code& code, Binding loosest) {
    return code.binding > loosest ? "(" + code.text + ")" : code.text;
}

OperatorText find_operator(Operator operation) {
    switch (operation) {
    case Operator::add:
        return {" + ", Binding::sum};
    case Operator::subtract:
        return {" - ", Binding::sum};
    case Operator::multiply:
        return {" * ", Binding::product};
    case Operator::divide:
        return {" / ", Binding::product};
    case Operator::equal:
        return {" == ", Binding::equality};
    case Operator::not_equal:
        return {" != ", Binding::equality};
    case Operator::less:
        return {" < ", Binding::order};
    case Operator::less_equal:
        return {" <= ", Binding::order};
    case Operator::greater:
        return {" > ", Binding::order};
    default:
        return {" >= ", Binding::order};
    }
}

namespace {

bool is_comparison(Operator operation) {
    return operation >= Operator::equal && operation <= Operator::greater_equal;
}

// The right operand of an operator that groups to the left must bind more tightly.
Code join(const Code& a, OperatorText operation, const Code& b) {
    const auto tighter = Binding(std::uint8_t(operation.binding) - 1);
    return {wrap(a, operation.binding) + operation.text + wrap(b, tighter), operation.binding,
            a.is_stable && b.is_stable, std::max(a.depth, b.depth) + 1};
}

// Mesa's device takes x · 0 and 0 / x for 0, and x / 0 for anything: it must not see that a factor is 0.
Code make_number(Type type, double value) {
    if (type == Type::real && float(value) == 0)
        return std::signbit(value) ? Code{"-ZERO", Binding::unary, true} : Code{"ZERO", Binding::primary, true};
    const std::string text = write_number(type, value);
    return {text, text[0] == '-' ? Binding::unary : Binding::primary, true};
}

} // namespace

Code Emitter::convert(const Code& code, Type from, Type to) {
    if (from == to || to != Type::real || from != Type::integer)
        return code;
    return {"real(" + code.text + ")", Binding::primary, code.is_stable, code.depth + 1};
}

Code Emitter::emit_as(const Expression& e, Type type) {
    if (type == Type::real && e.type == Type::integer)
        if (const std::optional<double> value = find_constant(m_program, m_loop, e))
            return make_number(type, *value);
    return convert(emit(e), e.type, type);
}

std::vector<Code> Emitter::emit_in_order(const std::vector<std::function<Code()>>& parts,
                                         const std::vector<Type>& types) {
    std::vector<Block> blocks(parts.size());
    std::vector<Code> codes(parts.size());
    std::size_t last_change = 0; // one past it
    for (std::size_t i = 0; i < parts.size(); ++i) {
        blocks[i] = capture([&] { codes[i] = parts[i](); });
        if (blocks[i].changes)
            last_change = i + 1;
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        append(blocks[i]);
        if (i + 1 < last_change && !codes[i].is_stable)
            codes[i] = keep(types[i], codes[i]);
    }
    return codes;
}

std::vector<Code> Emitter::emit_numbers(const Expression& call, std::size_t first, Type type) {
    std::vector<std::function<Code()>> parts;
    for (std::size_t i = first; i < call.operands.size(); ++i)
        parts.push_back([this, &call, i, type] { return emit_as(call.operands[i], type); });
    return emit_in_order(parts, std::vector<Type>(parts.size(), type));
}

Code Emitter::emit(const Expression& e) {
    // glslang computes constants in double precision.
    if (e.kind == Expression::Kind::binary || e.kind == Expression::Kind::unary || e.kind == Expression::Kind::builtin)
        if (const std::optional<double> value = find_constant(m_program, m_loop, e))
            return make_number(e.type, *value);
    switch (e.kind) {
    case Expression::Kind::number:
        return make_number(e.type, e.type == Type::integer ? double(e.integer) : double(e.real));
    case Expression::Kind::text:
        return {"0", Binding::primary, true};
    case Expression::Kind::variable:
        return emit_variable(e);
    case Expression::Kind::element:
        return emit_element(e);
    case Expression::Kind::list_item:
        return emit_list_item(e);
    case Expression::Kind::list_length: {
        const Code list = emit_list(e.operands[0]);
        return {list.text + ".y", Binding::primary, list.is_stable};
    }
    case Expression::Kind::convert:
        return emit_as(e.operands[0], e.type);
    case Expression::Kind::unary:
        return emit_unary(e);
    case Expression::Kind::binary:
        return keep_shallow(e.type, emit_binary(e));
    case Expression::Kind::conditional:
        return emit_conditional(e);
    case Expression::Kind::builtin:
        return keep_shallow(e.type, emit_builtin(e));
    case Expression::Kind::call:
        return emit_call(e);
    case Expression::Kind::assignment:
        return emit_assignment(e, true);
    }
    return {};
}

Code Emitter::emit_variable(const Expression& e) {
    if (const std::optional<double> value = find_constant(m_program, m_loop, e);
        value && variable(e.variable).array_size == 0 && e.type != Type::list)
        return make_number(e.type, *value);
    const std::string& name = m_names.at(e.variable);
    const bool is_stable = use_of(e.variable).role == Role::uniform || e.variable == m_loop.statement->variable;
    if (!is_checked(e.variable))
        return {name, Binding::primary, is_stable};
    return {"check_set(" + m_set_flags.at(e.variable) + ", " + name + ", " + find_site(Fault::unset_variable, e.span) +
                ")",
            Binding::primary, is_stable};
}

Code Emitter::emit_place(const Expression& index, const std::string& size, Fault outside, const std::string& after) {
    const Code code = emit(index);
    std::string text = after.empty() ? "find_place(" : "find_place_after(" + after + ", ";
    text += code.text + ", " + size + ", " + find_site(outside, index.span);
    if (index.type != Type::integer)
        text += ", " + find_site(Fault::not_integral, index.span);
    return {text + ")", Binding::primary, code.is_stable, code.depth + 1};
}

// Arrays that the loop does not write are read from the uniform words.
Code Emitter::emit_element(const Expression& e) {
    const Expression& index = e.operands[0];
    const Variable& array = variable(e.variable);
    const bool is_uniform = use_of(e.variable).role == Role::uniform;
    const std::string base = is_uniform ? std::to_string(m_word_of.at(e.variable)) + "u + " : "";
    const auto read = [&](const std::string& place) {
        if (!is_uniform)
            return m_names.at(e.variable) + "[" + place + "]";
        const std::string word = "uniform_words[" + base + "uint(" + place + ")]";
        return e.type == Type::integer ? "int(" + word + ")" : "uintBitsToFloat(" + word + ")";
    };
    if (const std::optional<double> at = find_constant(m_program, m_loop, index);
        at && *at == std::int32_t(*at) && *at >= 0 && *at < array.array_size)
        return {read(std::to_string(std::int32_t(*at))), Binding::primary, is_uniform};
    const std::string size = std::to_string(array.array_size), nothing = write_nothing(e.type);
    if (index.kind == Expression::Kind::variable && index.type == Type::integer) {
        const Code code = emit(index);
        return {"(is_inside(" + code.text + ", " + size + ", " + find_site(Fault::array_index, index.span) + ") ? " +
                    read(code.text) + " : " + nothing + ")",
                Binding::primary, is_uniform && code.is_stable};
    }
    const Code place = keep(Type::integer, emit_place(index, size, Fault::array_index));
    return {"(" + place.text + " >= 0 ? " + read(place.text) + " : " + nothing + ")", Binding::primary, is_uniform};
}

Code Emitter::emit_unary(const Expression& e) {
    const Expression& operand = e.operands[0];
    if (e.operation == Operator::logical_not) {
        const Code code = emit_condition(operand);
        return {"int(!" + wrap(code, Binding::primary) + ")", Binding::primary, code.is_stable, code.depth + 1};
    }
    const Code code = emit_as(operand, e.type);
    return {"-" + wrap(code, Binding::primary), Binding::unary, code.is_stable, code.depth + 1};
}

Code Emitter::emit_comparison(const Expression& e) {
    const bool is_real = e.operands[0].type == Type::real || e.operands[1].type == Type::real;
    const Type type = is_real ? Type::real : Type::integer;
    std::vector<Code> codes = emit_numbers(e, 0, type);
    for (Code& code : codes)
        if (code.text == "ZERO")
            code.text = "0.0";
    return join(codes[0], find_operator(e.operation), codes[1]);
}

Code Emitter::emit_binary(const Expression& e) {
    if (e.operation == Operator::logical_and || e.operation == Operator::logical_or || is_comparison(e.operation)) {
        const Code code = emit_condition(e);
        return {"int(" + code.text + ")", Binding::primary, code.is_stable, code.depth + 1};
    }
    const bool is_real = e.operation == Operator::divide || e.type == Type::real;
    const std::vector<Code> codes = emit_numbers(e, 0, is_real ? Type::real : Type::integer);
    if (e.operation == Operator::modulo)
        return {"script_remainder(" + codes[0].text + ", " + codes[1].text + ", " +
                    find_site(Fault::modulo_by_zero, e.span) + ")",
                Binding::primary, codes[0].is_stable && codes[1].is_stable,
                std::max(codes[0].depth, codes[1].depth) + 1};
    return join(codes[0], find_operator(e.operation), codes[1]);
}

// The right operand of && and || is left out where the left one decides.
Code Emitter::emit_lazy(const Expression& e) {
    const bool is_and = e.operation == Operator::logical_and;
    const Code left = emit_condition(e.operands[0]);
    Code right;
    ++m_indent;
    const Block block = capture([&] { right = emit_condition(e.operands[1]); });
    --m_indent;
    const Binding binding = is_and ? Binding::conjunction : Binding::disjunction;
    if (block.text.empty())
        return {wrap(left, Binding::equality) + (is_and ? " && " : " || ") + wrap(right, Binding::equality), binding,
                left.is_stable && right.is_stable, std::max(left.depth, right.depth) + 1};
    const Code result = keep("bool", left.text);
    open(std::string("if (") + (is_and ? "" : "!") + result.text + ")");
    append(block);
    write_line(result.text + " = " + right.text + ";");
    close();
    return result;
}

Code Emitter::emit_condition(const Expression& e) {
    if (const std::optional<double> value = find_constant(m_program, m_loop, e))
        return {*value != 0 ? "true" : "false", Binding::primary, true};
    if (e.kind == Expression::Kind::binary) {
        Code code;
        if (e.operation == Operator::logical_and || e.operation == Operator::logical_or)
            code = emit_lazy(e);
        else if (is_comparison(e.operation))
            code = emit_comparison(e);
        if (!code.text.empty())
            return code.depth > 16 ? keep("bool", code.text) : code;
    }
    if (e.kind == Expression::Kind::unary && e.operation == Operator::logical_not) {
        const Code code = emit_condition(e.operands[0]);
        return {"!" + wrap(code, Binding::primary), Binding::unary, code.is_stable, code.depth + 1};
    }
    if (e.kind == Expression::Kind::convert)
        return emit_condition(e.operands[0]);
    const Code code = emit(e);
    return {wrap(code, Binding::order) + (e.type == Type::real ? " != 0.0" : " != 0"), Binding::equality,
            code.is_stable, code.depth + 1};
}

Code Emitter::emit_conditional(const Expression& e) {
    const Code condition = emit_condition(e.operands[0]);
    Code codes[2];
    Block blocks[2];
    ++m_indent;
    for (int i = 0; i < 2; ++i)
        blocks[i] = capture([&] { codes[i] = emit_as(e.operands[i + 1], e.type); });
    --m_indent;
    if (blocks[0].text.empty() && blocks[1].text.empty())
        return keep_shallow(e.type, {"(" + condition.text + " ? " + codes[0].text + " : " + codes[1].text + ")",
                                     Binding::primary, condition.is_stable && codes[0].is_stable && codes[1].is_stable,
                                     std::max({condition.depth, codes[0].depth, codes[1].depth}) + 1});
    const Code result = keep(e.type, {write_nothing(e.type)});
    open("if (" + condition.text + ")");
    append(blocks[0]);
    write_line(result.text + " = " + codes[0].text + ";");
    close(" else {");
    ++m_indent;
    append(blocks[1]);
    write_line(result.text + " = " + codes[1].text + ";");
    close();
    return result;
}

Code Emitter::emit_list(const Expression& e) {
    const Code code = emit(e);
    return code.text.find('(') == std::string::npos ? code : keep(Type::list, code);
}

Code Emitter::emit_list_item(const Expression& e) {
    use("neighbors");
    const std::vector<Code> codes = emit_in_order({[&] { return emit_list(e.operands[0]); },
                                                   [&] {
                                                       const Expression& list = e.operands[0];
                                                       const std::string name = list.kind == Expression::Kind::variable
                                                                                    ? m_names.at(list.variable)
                                                                                    : "LIST";
                                                       return emit_place(e.operands[1], name + ".y", Fault::list_index);
                                                   }},
                                                  {Type::list, Type::integer});
    std::string place = codes[1].text;
    if (const std::size_t at = place.find("LIST.y"); at != std::string::npos)
        place.replace(at, 4, codes[0].text);
    return {"read_neighbor(" + codes[0].text + ", " + place + ")", Binding::primary, false, codes[1].depth + 1};
}

Code Emitter::emit_call(const Expression& e) {
    const Function& function = m_program.functions[e.function];
    std::vector<std::function<Code()>> parts;
    std::vector<Type> types;
    for (std::size_t i = 0; i < e.operands.size(); ++i) {
        types.push_back(variable(function.parameters[i]).type);
        parts.push_back([this, &e, i, type = types.back()] { return emit_as(e.operands[i], type); });
    }
    const std::vector<Code> codes = emit_in_order(parts, types);
    emit_function(function, e);
    std::string text = m_function_names.at(e.function) + "(";
    for (std::size_t i = 0; i < codes.size(); ++i)
        text += (i > 0 ? ", " : "") + codes[i].text;
    text += ")";
    if (!has_side_effects(m_program, e) || function.result == Type::none) {
        m_block.changes |= function.result == Type::none;
        return {text, Binding::primary, false, 4};
    }
    m_block.changes = true;
    return keep(function.result, {text});
}

} // namespace photonloupe::script
