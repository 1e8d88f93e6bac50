// SPDX-License-Identifier: Apache-2.0
// The emitter's state: GLSL text in the making, names, words and slots handed out.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "script/builtins.h"
#include "script/emit/emit.h"
#include "script/plan/accesses.h"
#include "script/plan/path_counters.h"

namespace photonloupe::script {

// How tightly an operator binds, the tightest first.
enum class Binding : std::uint8_t { primary, unary, product, sum, order, equality, conjunction, disjunction, choice };

struct OperatorText {
    const char* text;
    Binding binding;
};
OperatorText find_operator(Operator operation);

// An expression's GLSL, without side effects: what has any stands in statements before it.
struct Code {
    std::string text;
    Binding binding = Binding::primary;
    bool is_stable = false; // nothing that is evaluated later changes it
    std::uint32_t depth = 1;
};
std::string wrap(const Code& code, Binding loosest); // in parentheses where it binds no tighter

// Statements on their way into the text.
struct Block {
    std::string text;
    bool changes = false; // they assign what expressions can read
};

class Emitter {
public:
    Emitter(const Program& program, const PhotonLoop& loop) : m_program(program), m_loop(loop) {}
    EmittedPass emit();

private:
    // What a lane carries from photon to photon in registers, between loading and storing its slots.
    struct Register {
        std::string type, name;
        std::uint32_t slot;
        std::string load, store; // functions
    };

    // emit_words.cpp
    void name_variables();
    void plan_words();
    void plan_slots();
    bool is_literal(std::uint32_t variable) const;

    // emit_pass.cpp: the whole
    std::string compose_head();
    std::string compose_declarations() const;
    // With its set flag; for a function's own names inside its GLSL function.
    std::string declare_variable(std::uint32_t index, bool is_parameter = false) const;
    std::vector<Register> list_registers() const;
    std::string compose_start(std::uint32_t depth) const;
    std::string compose_finish() const;
    std::string compose_photon() const;
    std::string compose_loads() const;
    std::string compose_main() const;
    std::uint32_t count_fault_words() const { return std::uint32_t(m_pass.sites.size() + 32) / 32; }

    // emit_text.cpp: lines, temporaries, names, numbers
    void write_line(const std::string& text);
    void write_comment(Span span);
    void open(const std::string& head);
    void close(const std::string& tail = "");
    template <class Write>
    Block capture(const Write& write) {
        Block block;
        std::swap(block, m_block);
        write();
        std::swap(block, m_block);
        return block;
    }
    void append(const Block& block);
    Code keep(Type type, const Code& code); // in a temporary
    Code keep(const std::string& type, const std::string& text);
    Code keep_shallow(Type type, Code code); // in a temporary where it has grown deep or long
    std::string make_unique(const std::string& wish);
    std::string make_name(const std::string& prefix, const std::string& name);
    std::string find_site(const PassSite& wanted);
    std::string find_site(Fault kind, Span span) { return find_site({{kind, span}}); }
    void use(const std::string& library);

    // emit_expressions.cpp
    Code emit(const Expression& e);
    Code emit_as(const Expression& e, Type type);
    Code emit_condition(const Expression& e);
    // Left to right: what an earlier one gave is kept where a later one changes something.
    std::vector<Code> emit_in_order(const std::vector<std::function<Code()>>& parts, const std::vector<Type>& types);
    std::vector<Code> emit_numbers(const Expression& call, std::size_t first, Type type);
    Code emit_variable(const Expression& e);
    Code emit_element(const Expression& e);
    Code emit_unary(const Expression& e);
    Code emit_binary(const Expression& e);
    Code emit_comparison(const Expression& e);
    Code emit_lazy(const Expression& e);
    Code emit_conditional(const Expression& e);
    Code emit_list(const Expression& e);
    Code emit_list_item(const Expression& e);
    Code emit_call(const Expression& e);
    Code convert(const Code& code, Type from, Type to);
    // An index's place in [0, size), -1 outside; nothing is reported where the place `after` is -1.
    Code emit_place(const Expression& index, const std::string& size, Fault outside, const std::string& after = {});

    // emit_assignments.cpp
    Code emit_assignment(const Expression& e, bool is_used);
    Code assign_scalar(const Expression& e, bool is_used);
    Code assign_element(const Expression& e, bool is_used);
    std::string combine_text(const Expression& e, const std::string& before, const Code& value);

    // emit_reductions.cpp
    bool emit_reduction(const Expression& e);
    void emit_choice(const ChoiceStatement& choice);
    void emit_scalar_choice(const ChoiceStatement& choice, const Code& candidate);
    void emit_element_choice(const ChoiceStatement& choice, const Code& place, const Code& candidate);

    // emit_builtins.cpp, emit_photon_calls.cpp
    Code emit_builtin(const Expression& e);
    Code emit_math(const Expression& e);
    Code emit_pca(const Expression& e);
    Code emit_report(const Expression& e);
    Code emit_photon_call(const Expression& e);
    Code emit_column(const Expression& e, const std::string& function, const char* library);
    Code emit_path_call(const Expression& e);
    Code emit_get_parameter(const Expression& e);
    Code emit_set_parameter(const Expression& e);
    Code emit_set_color(const Expression& e);
    Code emit_query(const Expression& e);
    Code emit_photon(const Expression& e);
    std::string emit_dimension(const Expression& e);
    Code emit_vertex(const Expression& index, const std::string& path, Fault outside, const std::string& size);
    std::string pick_axis(const std::string& vector, const Expression& axis, const Code& place);

    // emit_statements.cpp
    void emit(const std::vector<Statement>& statements);
    void emit(const Statement& s);
    void emit_declaration(const Statement& s);
    void emit_branch(const Statement& s);
    void emit_loop(const Statement& s);
    void emit_short_loop(const Statement& s, const Code& condition, const std::string& last);
    void emit_long_loop(const Statement& s);
    void emit_photon_loop_inside(const Statement& s);
    void emit_unused(const Expression& e);
    void emit_unused(const std::vector<Expression>& list);
    void emit_return(const Statement& s);
    void emit_function(const Function& function, const Expression& call);
    std::string turn_check(const Statement& s);

    const VariableUse& use_of(std::uint32_t variable) const { return m_loop.variables.at(variable); }
    bool is_reduced(std::uint32_t variable) const;
    const Variable& variable(std::uint32_t index) const { return m_program.variables[index]; }
    bool is_checked(std::uint32_t variable) const { return m_loop.unset_reads.contains(variable); }

    const Program& m_program;
    const PhotonLoop& m_loop;
    EmittedPass m_pass;

    Block m_block;
    std::uint32_t m_indent = 1;
    std::uint32_t m_last_line = 0; // of the script, whose text was written as a comment
    std::uint32_t m_temporaries = 0;
    std::set<std::string> m_taken;                       // names
    std::map<std::uint32_t, std::string> m_names;        // of variables
    std::map<std::uint32_t, std::string> m_set_flags;    // of variables that may be unset
    std::map<std::uint32_t, std::string> m_photon_names; // of least and greatest scalars: who gave them
    std::map<std::uint32_t, std::uint32_t> m_word_of;    // uniform variables
    std::map<std::uint32_t, const ReducedSlots*> m_lane_of;
    std::map<std::uint32_t, std::string> m_function_names;
    std::set<std::uint32_t> m_function_variables; // declared inside GLSL functions
    std::set<std::string> m_libraries;            // of shaders/script/
    std::string m_functions;                      // GLSL of the script's functions so far
    const Function* m_function = nullptr;         // being emitted
    struct LoopContext {
        bool is_photon_loop = false;
        std::function<void()> before_next; // what `continue` must do first
    };
    std::vector<LoopContext> m_loops;
    std::vector<PathCounter> m_path_counters; // of the loops that are being emitted
    std::set<int> m_dimensions;               // of parameters that are set by a known number
    bool m_has_computed_dimensions = false;
    bool m_has_loops = false, m_has_element_reductions = false, m_uses_own_path = false;
    std::set<std::pair<std::uint32_t, std::string>> m_zeros; // arrays of zeros that declarations copy: size, type
};

} // namespace photonloupe::script
