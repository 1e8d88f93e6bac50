// SPDX-License-Identifier: Apache-2.0
// Assignments as GLSL statements: the index first, then the value, then the old value, as in the interpreter.
#include "script/emit/emitter.h"
#include "script/emit/glsl_numbers.h"

namespace photonloupe::script {

// `before` op value, for compound assignments.
std::string Emitter::combine_text(const Expression& e, const std::string& before, const Code& value) {
    if (e.operation == Operator::none)
        return value.text;
    if (e.operation == Operator::modulo)
        return "script_remainder(" + before + ", " + value.text + ", " + find_site(Fault::modulo_by_zero, e.span) + ")";
    return before + find_operator(e.operation).text + wrap(value, Binding::unary);
}

Code Emitter::assign_scalar(const Expression& e, bool is_used) {
    const Type type = variable(e.variable).type;
    const std::string& name = m_names.at(e.variable);
    const Code value = type == Type::list ? emit_list(e.operands[0]) : emit_as(e.operands[0], type);
    const bool is_compound = e.operation != Operator::none, is_checked_here = is_checked(e.variable);
    std::string before = name;
    if (is_compound && is_checked_here)
        before = "check_set(" + m_set_flags.at(e.variable) + ", " + name + ", " +
                 find_site(Fault::unset_variable, e.span) + ")";
    Code result{name};
    if (is_used && e.is_postfix) {
        result = keep(type, {before});
        before = result.text;
    }
    if (is_compound && before == name && e.operation != Operator::modulo) {
        const std::string sign = find_operator(e.operation).text;
        write_line(name + sign.substr(0, 2) + "= " + value.text + ";");
    } else {
        write_line(name + " = " + combine_text(e, before, value) + ";");
    }
    if (is_checked_here)
        write_line(m_set_flags.at(e.variable) + " = true;");
    m_block.changes = true;
    return result;
}

Code Emitter::assign_element(const Expression& e, bool is_used) {
    const Variable& array = variable(e.variable);
    const Expression& index = e.operands[1];
    const std::optional<double> at = find_constant(m_program, m_loop, index);
    const bool is_safe = at && *at == std::int32_t(*at) && *at >= 0 && *at < array.array_size;
    const std::vector<Code> codes = emit_in_order(
        {[&] {
             if (is_safe)
                 return Code{std::to_string(std::int32_t(*at)), Binding::primary, true};
             return keep(Type::integer, emit_place(index, std::to_string(array.array_size), Fault::array_index));
         },
         [&] {
             const Code value = emit_as(e.operands[0], array.type);
             // What it reports, it reports also where the write is dropped.
             return is_safe || value.text.find('(') == std::string::npos ? value : keep(array.type, value);
         }},
        {Type::integer, array.type});
    const std::string element = m_names.at(e.variable) + "[" + codes[0].text + "]", nothing = write_nothing(array.type);
    const std::string guarded = is_safe ? element : "(" + codes[0].text + " >= 0 ? " + element + " : " + nothing + ")";
    Code result{guarded};
    if (is_used && e.is_postfix)
        result = keep(array.type, {guarded});
    write_line((is_safe ? "" : "if (" + codes[0].text + " >= 0) ") + element + " = " +
               combine_text(e, element, codes[1]) + ";");
    m_block.changes = true;
    return result;
}

Code Emitter::emit_assignment(const Expression& e, bool is_used) {
    return variable(e.variable).array_size > 0 ? assign_element(e, is_used) : assign_scalar(e, is_used);
}

} // namespace photonloupe::script
