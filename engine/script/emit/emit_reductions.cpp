// SPDX-License-Identifier: Apache-2.0
// Steps of reductions as GLSL: scalars in registers, array elements in lane_words.
#include "script/emit/emitter.h"

namespace photonloupe::script {
namespace {

const char* find_element_function(Role role) {
    return role == Role::sum ? "sum_element(" : role == Role::minimum ? "minimum_element(" : "maximum_element(";
}

} // namespace

bool Emitter::is_reduced(std::uint32_t index) const {
    const Role role = use_of(index).role;
    return role != Role::local && role != Role::uniform && role != Role::carried;
}

// False: an ordinary assignment.
bool Emitter::emit_reduction(const Expression& e) {
    const std::optional<ReductionStep> step = match_reduction(m_program, e);
    if (!step || !is_reduced(step->variable))
        return false;
    const Type type = variable(step->variable).type;
    const std::string& name = m_names.at(step->variable);
    const std::string size = std::to_string(std::max(1u, variable(step->variable).array_size));
    const std::vector<Code> codes =
        emit_in_order({[&] { return step->index ? emit_place(*step->index, size, Fault::array_index) : Code{"0"}; },
                       [&] { return emit_as(*step->operand, type); }},
                      {Type::integer, type});
    const std::string value = step->is_negated ? "-(" + codes[1].text + ")" : codes[1].text;
    if (step->index)
        write_line(find_element_function(step->role) + std::to_string(m_lane_of.at(step->variable)->first) + "u, " +
                   codes[0].text + ", " + value + ");");
    else if (step->role == Role::sum)
        write_line(name + (step->is_negated ? " -= " : " += ") + codes[1].text + ";");
    else
        write_line(name + " = " + (step->role == Role::minimum ? "script_min(" : "script_max(") + name + ", " + value +
                   ");");
    m_block.changes = true;
    return true;
}

void Emitter::emit_scalar_choice(const ChoiceStatement& choice, const Code& candidate) {
    const std::string& name = m_names.at(choice.decided);
    open("if (" + candidate.text + (choice.role == Role::least ? " < " : " > ") + name + ")");
    write_line(name + " = " + candidate.text + ";");
    write_line(m_photon_names.at(choice.decided) + " = uint(photon);");
    for (const Expression* assignment : choice.payload)
        write_line(m_names.at(assignment->variable) + " = " +
                   emit_as(assignment->operands[0], variable(assignment->variable).type).text + ";");
    close();
}

void Emitter::emit_element_choice(const ChoiceStatement& choice, const Code& place, const Code& candidate) {
    const ReducedSlots& slots = *m_lane_of.at(choice.decided);
    open("if (choose_element(" + std::to_string(slots.first) + "u, " + std::to_string(slots.size) + "u, " + place.text +
         ", " + candidate.text + ", " + (choice.role == Role::least ? "true" : "false") + "))");
    for (const Expression* assignment : choice.payload)
        write_line("store(" + std::to_string(m_lane_of.at(assignment->variable)->first) + "u + uint(" + place.text +
                   "), " + emit_as(assignment->operands[0], variable(assignment->variable).type).text + ");");
    close();
    if (variable(choice.decided).type != Type::integer)
        return;
    // Outside the array the candidate is compared with 0, and may win: then each assignment is reported, and dropped.
    const std::string would_win =
        place.text + " < 0 && " + candidate.text + (choice.role == Role::least ? " < 0" : " > 0");
    std::vector<const Expression*> assignments{choice.decision};
    assignments.insert(assignments.end(), choice.payload.begin(), choice.payload.end());
    for (const Expression* assignment : assignments)
        write_line("fault_if(" + would_win + ", " + find_site(Fault::array_index, assignment->operands[1].span) + ");");
}

void Emitter::emit_choice(const ChoiceStatement& choice) {
    const Type type = variable(choice.decided).type;
    Code candidate = emit_as(*choice.candidate, type);
    if (candidate.binding != Binding::primary || candidate.text.find('(') != std::string::npos)
        candidate = keep(type, candidate);
    if (!choice.index)
        return emit_scalar_choice(choice, candidate);
    const std::string size = std::to_string(variable(choice.decided).array_size);
    emit_element_choice(choice, keep(Type::integer, emit_place(*choice.index, size, Fault::array_index)), candidate);
}

} // namespace photonloupe::script
