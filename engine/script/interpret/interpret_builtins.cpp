// SPDX-License-Identifier: Apache-2.0
// The interpreter's predefined calls: mathematics by the table's reference functions, PCA, histograms, prints.
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "script/builtins.h"
#include "script/interpret/interpreter.h"
#include "script/reference_math.h"

namespace photonloupe::script {
namespace {

constexpr std::size_t LONGEST_SIGNATURE = 6; // dot of two 3-D vectors

std::string format_number(Type type, Number value) {
    char text[32];
    if (type == Type::integer)
        std::snprintf(text, sizeof text, "%d", value.integer);
    else if (std::isnan(value.real))
        return "nan";
    else
        std::snprintf(text, sizeof text, "%.6g", static_cast<double>(value.real));
    return text;
}

} // namespace

Number Interpreter::call_builtin(const Expression& expression) {
    switch (expression.builtin->id) {
    case BuiltinId::get_num_photons:
        return make_integer(static_cast<std::int32_t>(m_photons.count));
    case BuiltinId::declare_photon_parameter:
        declare_parameter(expression);
        return make_integer(0);
    case BuiltinId::set_photon_parameter:
        set_parameter(expression);
        return make_integer(0);
    case BuiltinId::set_photon_colour_encoding:
        set_color(expression);
        return make_integer(0);
    case BuiltinId::get_photon_parameter:
        return read_parameter(expression);
    case BuiltinId::decompose_pca_2d:
        return make_integer(decompose_moments(m_state.pca_2d, 2, m_state.decomposition));
    case BuiltinId::decompose_pca_3d:
        return make_integer(decompose_moments(m_state.pca_3d, 3, m_state.decomposition));
    case BuiltinId::histogram:
        add_to_histogram(expression);
        return make_integer(0);
    case BuiltinId::print:
        print(expression);
        return make_integer(0);
    default:
        break;
    }
    switch (expression.builtin->effect) {
    case Effect::changes_pca:
        change_pca(expression);
        return make_integer(0);
    case Effect::reads_pca:
        return read_pca(expression);
    case Effect::reads_photon:
        return expression.builtin->columns & COLUMN_PATH_STARTS ? read_path(expression) : read_photon(expression);
    default:
        return call_pure(expression);
    }
}

Number Interpreter::call_pure(const Expression& expression) {
    const Builtin& builtin = *expression.builtin;
    const std::size_t count = expression.operands.size();
    std::array<Number, LONGEST_SIGNATURE> values{};
    bool are_integers = true;
    for (std::size_t i = 0; i < count; ++i) {
        values[i] = evaluate(expression.operands[i]);
        are_integers = are_integers && expression.operands[i].type == Type::integer;
    }
    if (expression.type == Type::integer && are_integers && builtin.reference_integer) {
        const std::array<std::int32_t, 3> integers{values[0].integer, values[1].integer, values[2].integer};
        if (builtin.id == BuiltinId::pow && !raise_integer(integers[0], integers[1]).fits)
            fault(Fault::does_not_fit, expression);
        if (builtin.id == BuiltinId::mod && integers[1] == 0)
            fault(Fault::modulo_by_zero, expression);
        return make_integer(builtin.reference_integer({integers.data(), count}));
    }
    std::array<float, LONGEST_SIGNATURE> reals{};
    for (std::size_t i = 0; i < count; ++i)
        reals[i] =
            expression.operands[i].type == Type::integer ? static_cast<float>(values[i].integer) : values[i].real;
    if (builtin.id == BuiltinId::random) {
        const auto item = [&](std::size_t i) {
            return expression.operands[i].type == Type::integer
                       ? values[i].integer
                       : convert_to_integer(values[i].real, expression.operands[i]);
        };
        const std::int32_t index = item(0), salt = item(1);
        return make_real(draw_random(m_settings.seed, index, salt));
    }
    const float result = builtin.reference({reals.data(), count});
    return expression.type == Type::integer ? make_integer(convert_to_integer(result, expression)) : make_real(result);
}

void Interpreter::change_pca(const Expression& expression) {
    const BuiltinId id = expression.builtin->id;
    Moments& moments = is_planar(id) ? m_state.pca_2d : m_state.pca_3d;
    if (id == BuiltinId::reset_pca_2d || id == BuiltinId::reset_pca_3d) {
        moments = {};
        return;
    }
    std::array<float, 3> point{};
    for (std::size_t i = 0; i < expression.operands.size(); ++i)
        point[i] = evaluate_real(expression.operands[i]);
    push_point(moments, {point.data(), expression.operands.size()}, m_iteration.photon);
}

Number Interpreter::read_pca(const Expression& expression) {
    const Decomposition& found = m_state.decomposition;
    const auto dimensions = static_cast<std::size_t>(found.dimensions);
    std::array<std::size_t, 2> places{};
    for (std::size_t i = 0; i < expression.operands.size(); ++i) {
        places[i] = find_place(expression.operands[i], dimensions, Fault::eigen_index);
        if (places[i] == dimensions)
            return make_real(NOT_A_NUMBER);
    }
    switch (expression.builtin->id) {
    case BuiltinId::get_pca_eigenvalue:
        return make_real(found.eigenvalues[places[0]]);
    case BuiltinId::get_pca_mean:
        return make_real(found.mean[places[0]]);
    default:
        return make_real(found.eigenvectors[places[0]][places[1]]);
    }
}

void Interpreter::add_to_histogram(const Expression& expression) {
    const std::vector<Expression>& operands = expression.operands;
    const float value = evaluate_real(operands[1]), low = evaluate_real(operands[2]), high = evaluate_real(operands[3]);
    const float bins = operands.size() > 4 ? evaluate_real(operands[4]) : static_cast<float>(DEFAULT_BINS);
    if (!(low < high) || !std::isfinite(high - low) || !(bins >= 1 && bins <= MOST_BINS) || bins != std::trunc(bins)) {
        fault(Fault::histogram_range, expression);
        return;
    }
    if (m_is_replay)
        return;
    const auto bin_count = static_cast<std::uint32_t>(bins);
    if (m_outputs.histograms.size() >= HISTOGRAM_LIMIT &&
        !m_outputs.seek_histogram(operands[0].label, low, high, bin_count)) {
        fault(Fault::histogram_range, expression);
        return;
    }
    const std::size_t place = m_outputs.find_histogram(operands[0].label, low, high, bin_count);
    if (m_iteration.loop)
        m_iteration.samples.push_back({place, value});
    else
        m_outputs.histograms[place].add(value);
}

void Interpreter::print(const Expression& expression) {
    std::string line = expression.operands[0].label;
    for (std::size_t i = 1; i < expression.operands.size(); ++i)
        line += ' ' + format_number(expression.operands[i].type, evaluate(expression.operands[i]));
    std::vector<std::string>& lines = m_iteration.loop ? m_iteration.prints : m_outputs.prints;
    if (lines.size() >= (m_iteration.loop ? PRINT_LIMIT : UNIFORM_PRINT_LIMIT))
        return;
    if (m_iteration.loop)
        line = "photon " + std::to_string(m_iteration.photon) + ": " + line;
    lines.push_back(std::move(line));
}

} // namespace photonloupe::script
