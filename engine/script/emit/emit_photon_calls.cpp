// SPDX-License-Identifier: Apache-2.0
// Predefined calls that are about photons: columns, paths, parameters, colors, neighbours.
#include <algorithm>

#include "script/emit/emitter.h"

namespace photonloupe::script {
namespace {

const char* const COMPONENTS[] = {".x", ".y", ".z"};

bool is_axis(const std::optional<double>& value) {
    return value && (*value == 0 || *value == 1 || *value == 2);
}

// As a whole number, where it is one that a dimension can have.
std::optional<int> find_dimension(const std::optional<double>& value) {
    if (value && *value >= 0 && *value < 16 && *value == int(*value))
        return int(*value);
    return std::nullopt;
}

} // namespace

// The loop's own photon exists; others are looked up: -1 for none.
Code Emitter::emit_photon(const Expression& e) {
    if (is_loop_photon(m_loop, e))
        return {m_names.at(m_loop.statement->variable), Binding::primary, true};
    return emit_place(e, "int(settings.photon_count)", Fault::photon_index);
}

Code Emitter::emit_photon_call(const Expression& e) {
    switch (e.builtin->id) {
    case BuiltinId::get_num_photons:
        return {"int(settings.photon_count)", Binding::primary, true};
    case BuiltinId::get_photon_position:
        return emit_column(e, "read_position", "positions");
    case BuiltinId::get_photon_normal:
        return emit_column(e, "read_normal", "normals");
    case BuiltinId::get_photon_power:
        return emit_column(e, "read_power", "powers");
    case BuiltinId::get_photon_emitter:
        use("positions");
        return {"read_emitter(" + emit_photon(e.operands[0]).text + ")", Binding::primary, false, 4};
    case BuiltinId::get_photon_parameter:
        return emit_get_parameter(e);
    case BuiltinId::set_photon_parameter:
        return emit_set_parameter(e);
    case BuiltinId::set_photon_colour_encoding:
        return emit_set_color(e);
    case BuiltinId::get_knn:
    case BuiltinId::get_parameter_knn:
    case BuiltinId::get_constrained_knn:
        return emit_query(e);
    default:
        return emit_path_call(e);
    }
}

// A vector's component; a computed axis is looked up.
std::string Emitter::pick_axis(const std::string& vector, const Expression& axis, const Code& place) {
    if (const std::optional<double> constant = find_constant(m_program, m_loop, axis); is_axis(constant))
        return vector + COMPONENTS[int(*constant)];
    use("axes");
    return "pick_axis(" + vector + ", " + place.text + ")";
}

Code Emitter::emit_column(const Expression& e, const std::string& function, const char* library) {
    use(library);
    const bool is_known = is_axis(find_constant(m_program, m_loop, e.operands[1]));
    const std::vector<Code> codes =
        emit_in_order({[&] { return emit_photon(e.operands[0]); },
                       [&] { return is_known ? Code{"0"} : emit_place(e.operands[1], "3", Fault::axis_index); }},
                      {Type::integer, Type::integer});
    return {pick_axis(function + "(" + codes[0].text + ")", e.operands[1], codes[1]), Binding::primary,
            codes[0].is_stable && (is_known || codes[1].is_stable), codes[1].depth + 2};
}

Code Emitter::emit_path_call(const Expression& e) {
    use("paths");
    const bool is_own = is_loop_photon(m_loop, e.operands[0]);
    m_uses_own_path |= is_own;
    const auto find_path = [&] {
        if (is_own)
            return Code{"own_path", Binding::primary, true};
        const Code id = emit_photon(e.operands[0]);
        if (e.operands.size() == 1)
            return Code{"find_path(" + id.text + ")", Binding::primary, id.is_stable, id.depth + 1};
        // In a temporary: of a photon that does not exist nothing else is reported.
        return keep("uvec2", "find_path(" + id.text + ")");
    };
    if (e.builtin->id == BuiltinId::get_num_path_vertices) {
        const Code path = find_path();
        return {"int(" + path.text + ".y)", Binding::primary, path.is_stable, path.depth + 1};
    }
    const bool has_axis = e.operands.size() > 2;
    const bool is_known = has_axis && is_axis(find_constant(m_program, m_loop, e.operands[2]));
    std::string path;
    const std::vector<Code> codes = emit_in_order(
        {[&] {
             const Code code = find_path();
             path = code.text;
             return code;
         },
         [&] { return emit_vertex(e.operands[1], path, Fault::vertex_index, "int(" + path + ".y)"); },
         [&] { return has_axis && !is_known ? emit_vertex(e.operands[2], path, Fault::axis_index, "3") : Code{"0"}; }},
        {Type::none, Type::integer, Type::integer});
    const std::string arguments = "(" + path + ", " + codes[1].text + ")";
    const bool is_stable = codes[1].is_stable && (!has_axis || is_known || codes[2].is_stable);
    const std::uint32_t depth = std::max(codes[1].depth, codes[2].depth) + 2;
    const auto finish = [&](const std::string& text) { return Code{text, Binding::primary, is_stable, depth}; };
    switch (e.builtin->id) {
    case BuiltinId::get_path_vertex:
        use("path_vertices");
        return finish(pick_axis("read_vertex" + arguments, e.operands[2], codes[2]));
    case BuiltinId::get_path_normal:
        use("path_normals");
        return finish(pick_axis("read_path_normal" + arguments, e.operands[2], codes[2]));
    case BuiltinId::get_path_interaction:
        use("path_vertices");
        return finish("read_interaction" + arguments);
    case BuiltinId::get_path_object:
        use("path_vertices");
        return finish("read_object" + arguments);
    default:
        use("path_normals");
        return finish("read_path_normal" + arguments + ".w");
    }
}

// A vertex or axis of a path: not looked at where the photon does not exist.
Code Emitter::emit_vertex(const Expression& index, const std::string& path, Fault outside, const std::string& size) {
    const auto names = [&](const PathCounter& counter) { return is_on_path(m_program, m_loop, counter, index); };
    if (path == "own_path" && outside == Fault::vertex_index &&
        std::any_of(m_path_counters.begin(), m_path_counters.end(), names))
        return emit(index);
    if (path == "own_path")
        return emit_place(index, size, outside);
    return emit_place(index, size, outside, "int(" + path + ".y) - 1");
}

// A dimension as a number: 0-2 are the position, -1 is none.
std::string Emitter::emit_dimension(const Expression& e) {
    return emit_place(e, "3 + int(settings.parameter_count)", Fault::dimension_index).text;
}

Code Emitter::emit_get_parameter(const Expression& e) {
    const std::optional<int> constant = find_dimension(find_constant(m_program, m_loop, e.operands[1]));
    if (constant && *constant < 3)
        return emit_column(e, "read_position", "positions");
    use("parameters");
    const bool is_own = is_loop_photon(m_loop, e.operands[0]) && m_loop.sets_parameters;
    if (is_own && constant) {
        const std::string dimension = std::to_string(*constant);
        return {"(is_inside(" + dimension + ", 3 + int(settings.parameter_count), " +
                    find_site(Fault::dimension_index, e.operands[1].span) + ") ? read_own_parameter(" + dimension +
                    ") : NAN)",
                Binding::primary, false, 4};
    }
    const std::vector<Code> codes =
        emit_in_order({[&] { return emit_photon(e.operands[0]); },
                       [&] { return keep(Type::integer, {emit_dimension(e.operands[1])}); }},
                      {Type::integer, Type::integer});
    const std::string read = is_own ? "read_own_parameter(" + codes[1].text + ")"
                                    : "read_parameter(" + codes[0].text + ", " + codes[1].text + ")";
    if (constant)
        return {read, Binding::primary, false, 4};
    use("positions");
    use("axes");
    return {"(" + codes[1].text + " < 3 ? pick_axis(read_position(" + codes[0].text + "), " + codes[1].text +
                ") : " + read + ")",
            Binding::primary, false, 4};
}

Code Emitter::emit_set_parameter(const Expression& e) {
    use("parameters");
    const Expression& dimension = e.operands[1];
    const std::optional<int> constant = find_dimension(find_constant(m_program, m_loop, dimension));
    const std::string site = find_site(Fault::dimension_index, dimension.span);
    const std::vector<Code> codes =
        emit_in_order({[&] {
                           if (constant)
                               return Code{std::to_string(*constant), Binding::primary, true};
                           return keep(Type::integer, {emit_dimension(dimension)});
                       },
                       [&] { return emit_as(e.operands[2], Type::real); }},
                      {Type::integer, Type::real});
    if (constant)
        m_dimensions.insert(*constant);
    m_has_computed_dimensions |= !constant;
    const std::string call = "stage_parameter(" + codes[0].text + ", " + codes[1].text + ");";
    if (constant) {
        write_line("if (is_inside(" + codes[0].text + " - 3, int(settings.parameter_count), " + site + ")) " + call);
    } else {
        write_line("fault_if(" + codes[0].text + " >= 0 && " + codes[0].text + " < 3, " + site + ");");
        write_line(call);
    }
    m_block.changes = true;
    return {"0", Binding::primary, true};
}

Code Emitter::emit_set_color(const Expression& e) {
    use("colors");
    const std::vector<Code> codes = emit_numbers(e, 1, Type::real);
    write_line("staged_color = vec4(" + codes[0].text + ", " + codes[1].text + ", " + codes[2].text + ", 1.0);");
    m_block.changes = true;
    return {"0", Binding::primary, true};
}

Code Emitter::emit_query(const Expression& e) {
    use("neighbors");
    for (std::size_t i = 0; i < m_loop.queries.size(); ++i) {
        if (m_loop.queries[i].call != &e)
            continue;
        const Code photon = emit_photon(e.operands[0]);
        return {"find_neighbors(" + std::to_string(m_pass.queries[i].first_word) + "u, " + photon.text + ", " +
                    find_site(Fault::query, e.span) + ")",
                Binding::primary, photon.is_stable, photon.depth + 1};
    }
    return {"ivec2(0)"};
}

} // namespace photonloupe::script
