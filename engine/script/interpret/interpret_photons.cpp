// SPDX-License-Identifier: Apache-2.0
// The interpreter's calls about photons: their columns, paths, parameters, colors and neighbours.
#include <cmath>
#include <limits>

#include "script/builtins.h"
#include "script/interpret/interpreter.h"

namespace photonloupe::script {
namespace {

constexpr std::size_t AXES = 3;

} // namespace

Number Interpreter::read_photon(const Expression& expression) {
    const std::size_t photon = find_place(expression.operands[0], m_photons.count, Fault::photon_index);
    m_photons.require(expression.builtin->columns);
    if (expression.builtin->id == BuiltinId::get_photon_emitter)
        return make_integer(photon < m_photons.count ? m_photons.emitters[photon] : 0);
    const std::size_t axis = find_place(expression.operands[1], AXES, Fault::axis_index);
    if (photon == m_photons.count || axis == AXES)
        return make_real(NOT_A_NUMBER);
    const BuiltinId id = expression.builtin->id;
    const std::vector<float>& column = id == BuiltinId::get_photon_position ? m_photons.positions
                                       : id == BuiltinId::get_photon_normal ? m_photons.normals
                                                                            : m_photons.power;
    return make_real(column[AXES * photon + axis]);
}

Number Interpreter::read_path(const Expression& expression) {
    const BuiltinId id = expression.builtin->id;
    const Number nothing = make_nothing(expression.type);
    const std::size_t photon = find_place(expression.operands[0], m_photons.count, Fault::photon_index);
    m_photons.require(expression.builtin->columns);
    const bool has_photon = photon < m_photons.count;
    const std::int64_t first = has_photon ? m_photons.path_starts[photon] : 0;
    const std::int64_t count = has_photon ? m_photons.path_starts[photon + 1] - first : 0;
    if (id == BuiltinId::get_num_path_vertices)
        return has_photon ? make_integer(static_cast<std::int32_t>(count)) : nothing;
    if (!has_photon) { // its vertices are not asked for, but the other arguments may do something
        for (std::size_t i = 1; i < expression.operands.size(); ++i)
            evaluate(expression.operands[i]);
        return nothing;
    }
    const std::size_t place = find_place(expression.operands[1], static_cast<std::size_t>(count), Fault::vertex_index);
    const std::size_t vertex = static_cast<std::size_t>(first) + place;
    const bool has_axis = expression.operands.size() > 2;
    const std::size_t axis = has_axis ? find_place(expression.operands[2], AXES, Fault::axis_index) : 0;
    if (place == static_cast<std::size_t>(count) || axis == AXES)
        return nothing;
    switch (id) {
    case BuiltinId::get_path_vertex:
        return make_real(m_photons.path_vertices[AXES * vertex + axis]);
    case BuiltinId::get_path_normal:
        return make_real(m_photons.path_normals[AXES * vertex + axis]);
    case BuiltinId::get_path_interaction:
        return make_integer(m_photons.path_interactions[vertex]);
    case BuiltinId::get_path_object:
        return make_integer(m_photons.path_objects[vertex]);
    default:
        return make_real(m_photons.path_scatter[vertex]);
    }
}

Number Interpreter::read_parameter(const Expression& expression) {
    ScriptColumns& columns = m_outputs.columns;
    const std::size_t photon = find_place(expression.operands[0], m_photons.count, Fault::photon_index);
    const std::size_t end = FIRST_DIMENSION + columns.declared().size();
    const std::size_t dimension = find_place(expression.operands[1], end, Fault::dimension_index);
    if (photon == m_photons.count || dimension == end)
        return make_real(NOT_A_NUMBER);
    if (dimension < FIRST_DIMENSION) {
        m_photons.require(COLUMN_POSITION);
        return make_real(m_photons.positions[AXES * photon + dimension]);
    }
    const std::size_t index = dimension - FIRST_DIMENSION;
    if (m_iteration.loop && photon == m_iteration.photon && m_iteration.has_parameter[index])
        return make_real(m_iteration.parameters[index]);
    const float value = columns.read_parameter(index, photon);
    return make_real(is_unset(value) ? NOT_A_NUMBER : value); // arithmetic would carry the mark of the unset along
}

// Its label, else the constant that names its dimension (GAMMA), else p3; never a name that another one has.
std::string Interpreter::name_parameter(std::size_t dimension, const Expression& written, std::string label) const {
    if (label.empty() && written.kind == Expression::Kind::variable && m_program.variables[written.variable].constant)
        label = m_program.variables[written.variable].name;
    const std::vector<DeclaredParameter>& declared = m_outputs.columns.declared();
    for (std::size_t i = 0; i < declared.size(); ++i)
        if (i + FIRST_DIMENSION != dimension && declared[i].name == label)
            label.clear();
    return label.empty() ? "p" + std::to_string(dimension) : label;
}

void Interpreter::declare_parameter(const Expression& expression) {
    const std::vector<Expression>& operands = expression.operands;
    const std::size_t dimension = find_place(operands[0], LAST_DIMENSION + 1, Fault::dimension_index);
    DeclaredParameter parameter;
    parameter.low = evaluate_real(operands[1]);
    parameter.high = evaluate_real(operands[2]);
    parameter.name = operands.size() > 3 ? operands[3].label : std::string();
    parameter.is_periodic = operands.size() > 4 && evaluate_truth(operands[4]);
    if (dimension < FIRST_DIMENSION || dimension > LAST_DIMENSION || !(parameter.low < parameter.high) ||
        !std::isfinite(parameter.high - parameter.low)) {
        fault(Fault::declaration, expression);
        return;
    }
    parameter.name = name_parameter(dimension, operands[0], std::move(parameter.name));
    if (dimension > FIRST_DIMENSION + m_outputs.columns.declared().size())
        m_last_declared = &expression;
    m_outputs.columns.declare(static_cast<std::uint32_t>(dimension), std::move(parameter));
}

void Interpreter::set_parameter(const Expression& expression) {
    ScriptColumns& columns = m_outputs.columns;
    const std::size_t photon = find_place(expression.operands[0], m_photons.count, Fault::photon_index);
    const std::size_t end = FIRST_DIMENSION + columns.declared().size();
    const std::size_t dimension = find_place(expression.operands[1], end, Fault::dimension_index);
    const float value = evaluate_real(expression.operands[2]);
    if (photon == m_photons.count || dimension == end)
        return;
    if (dimension < FIRST_DIMENSION) {
        fault(Fault::dimension_index, expression.operands[1]);
        return;
    }
    const std::size_t index = dimension - FIRST_DIMENSION;
    if (m_iteration.loop && photon == m_iteration.photon) {
        m_iteration.parameters[index] = value;
        m_iteration.has_parameter[index] = true;
    } else {
        columns.write_parameter(index, photon, value);
    }
}

void Interpreter::set_color(const Expression& expression) {
    const std::size_t photon = find_place(expression.operands[0], m_photons.count, Fault::photon_index);
    float color[AXES];
    for (std::size_t i = 0; i < AXES; ++i)
        color[i] = evaluate_real(expression.operands[i + 1]);
    if (photon == m_photons.count)
        return;
    if (m_iteration.loop && photon == m_iteration.photon) {
        std::copy_n(color, AXES, m_iteration.color);
        m_iteration.has_color = true;
        return;
    }
    m_outputs.columns.write_color(photon, color);
}

std::vector<std::int32_t> Interpreter::find_neighbors(const Expression& expression) {
    const BuiltinId id = expression.builtin->id;
    const std::vector<Expression>& operands = expression.operands;
    const std::size_t photon = find_place(operands[0], m_photons.count, Fault::photon_index);
    float k = DEFAULT_NEIGHBORS;
    if (operands.size() > 1)
        k = evaluate_real(operands[1]);
    const float beta = operands.size() > 2 ? evaluate_real(operands[2]) : 0.0f;
    const bool is_constrained = id == BuiltinId::get_constrained_knn;
    const bool is_valid = k >= 1 && k <= float{MOST_NEIGHBORS} && k == std::trunc(k) && (!is_constrained || beta >= 0);
    if (!is_valid)
        fault(Fault::query, expression);
    if (!is_valid || photon == m_photons.count)
        return {};
    const NeighborQuery::Space space = id == BuiltinId::get_knn             ? NeighborQuery::Space::world
                                       : id == BuiltinId::get_parameter_knn ? NeighborQuery::Space::parameter
                                                                            : NeighborQuery::Space::constrained;
    return m_photons.find_neighbors(space, static_cast<std::uint32_t>(photon), static_cast<std::uint32_t>(k), beta);
}

} // namespace photonloupe::script
