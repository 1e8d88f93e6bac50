// SPDX-License-Identifier: Apache-2.0
// Predefined calls that are about numbers: mathematics, PCA, histograms, prints.
#include "script/emit/emitter.h"
#include "script/plan/substitute.h"
#include "shared/script.h"

namespace photonloupe::script {
namespace {

std::string join_arguments(const std::vector<Code>& codes) {
    std::string text;
    for (const Code& code : codes)
        text += (text.empty() ? "" : ", ") + code.text;
    return text;
}

Code make_call(const std::string& text, const std::vector<Code>& codes) {
    Code call{text, Binding::primary, true};
    for (const Code& code : codes) {
        call.is_stable &= code.is_stable;
        call.depth = std::max(call.depth, code.depth + 1);
    }
    return call;
}

bool are_integers(const Expression& e) {
    for (const Expression& operand : e.operands)
        if (operand.type != Type::integer)
            return false;
    return true;
}

} // namespace

Code Emitter::emit_builtin(const Expression& e) {
    switch (e.builtin->effect) {
    case Effect::reads_photon:
    case Effect::queries:
    case Effect::sets_photon:
        return emit_photon_call(e);
    case Effect::changes_pca:
    case Effect::decomposes_pca:
    case Effect::reads_pca:
        return emit_pca(e);
    case Effect::reports:
        return emit_report(e);
    default:
        return emit_math(e);
    }
}

Code Emitter::emit_math(const Expression& e) {
    const std::string name(e.builtin->glsl);
    const BuiltinId id = e.builtin->id;
    if (id == BuiltinId::random) {
        std::vector<std::function<Code()>> parts;
        for (const Expression& operand : e.operands)
            parts.push_back([this, &operand] {
                const Code code = emit(operand);
                if (operand.type == Type::integer)
                    return code;
                return Code{"to_integer(" + code.text + ", " + find_site(Fault::does_not_fit, operand.span) + ")",
                            Binding::primary, code.is_stable, code.depth + 1};
            });
        const std::vector<Code> codes = emit_in_order(parts, {Type::integer, Type::integer});
        return make_call("script_random(" + join_arguments(codes) + ")", codes);
    }
    const bool stays_integer = e.type == Type::integer && are_integers(e);
    const std::vector<Code> codes = emit_numbers(e, 0, stays_integer ? Type::integer : Type::real);
    const bool rounds =
        id == BuiltinId::int_ || id == BuiltinId::floor || id == BuiltinId::ceil || id == BuiltinId::round;
    if (rounds && stays_integer)
        return codes[0];
    std::string text = name + "(" + join_arguments(codes);
    if (rounds || (id == BuiltinId::pow && stays_integer))
        text += ", " + find_site(Fault::does_not_fit, e.span);
    else if (id == BuiltinId::mod && stays_integer)
        text += ", " + find_site(Fault::modulo_by_zero, e.span);
    return make_call(text + ")", codes);
}

Code Emitter::emit_pca(const Expression& e) {
    use("pca");
    const BuiltinId id = e.builtin->id;
    const bool is_plane = is_planar(id);
    const std::string moments = is_plane ? "moments_2d" : "moments_3d";
    if (e.builtin->effect != Effect::reads_pca)
        m_block.changes = true;
    switch (id) {
    case BuiltinId::reset_pca_2d:
    case BuiltinId::reset_pca_3d:
        write_line(moments + " = NO_MOMENTS;");
        return {"0", Binding::primary, true};
    case BuiltinId::push_pca_2d:
    case BuiltinId::push_pca_3d: {
        const std::vector<Code> codes = emit_numbers(e, 0, Type::real);
        write_line("push_point(" + moments + ", vec3(" + join_arguments(codes) + (is_plane ? ", 0.0" : "") + "));");
        m_block.changes = true;
        return {"0", Binding::primary, true};
    }
    case BuiltinId::decompose_pca_2d:
    case BuiltinId::decompose_pca_3d:
        return keep(Type::integer,
                    {"decompose_moments(" + moments + ", " + (is_plane ? "2" : "3") + ", decomposition)"});
    default:
        break;
    }
    const Code first = emit_place(e.operands[0], "decomposition.dimensions", Fault::eigen_index);
    if (id == BuiltinId::get_pca_eigenvalue)
        return {"read_eigenvalue(decomposition, " + first.text + ")", Binding::primary, false, 4};
    if (id == BuiltinId::get_pca_mean)
        return {"read_mean(decomposition, " + first.text + ")", Binding::primary, false, 4};
    const Code component = keep(Type::integer, first);
    const Code axis = emit_place(e.operands[1], "decomposition.dimensions", Fault::eigen_index, component.text);
    return {"read_eigenvector(decomposition, " + component.text + ", " + axis.text + ")", Binding::primary, false, 4};
}

Code Emitter::emit_report(const Expression& e) {
    m_block.changes = true;
    if (e.builtin->id == BuiltinId::print) {
        use("prints");
        for (std::size_t i = 1; i < e.operands.size(); ++i)
            emit_unused(e.operands[i]);
        write_line("has_printed = true;");
        return {"0", Binding::primary, true};
    }
    use("histograms");
    m_has_element_reductions = true;
    const auto give = [&](const Expression& operand) { return substitute_given(m_program, m_loop, operand); };
    PassHistogram histogram{&e, e.operands[0].label,      give(e.operands[2]), give(e.operands[3]),
                            {}, m_pass.uniform_word_count};
    if (e.operands.size() > 4)
        histogram.bins = give(e.operands[4]);
    m_pass.uniform_word_count += shared::HISTOGRAM_STRIDE;
    const Code value = emit_as(e.operands[1], Type::real);
    write_line("script_histogram(" + std::to_string(histogram.first_word) + "u, " + value.text + ", " +
               find_site(Fault::histogram_range, e.span) + ");");
    m_pass.histograms.push_back(std::move(histogram));
    return {"0", Binding::primary, true};
}

} // namespace photonloupe::script
