// SPDX-License-Identifier: Apache-2.0
// Photon loops in the interpreter: iterations that stage what they write, and reductions in blocks and lanes.
#include <algorithm>
#include <cmath>

#include "script/interpreter.h"

namespace photonloupe::script {
namespace {

bool is_reduction(Role role) {
    return role != Role::local && role != Role::uniform && role != Role::carried;
}

bool is_choice(Role role) { return role == Role::least || role == Role::greatest; }

// Pairwise, results pairwise again; an odd one out moves up unchanged.
template <class T, class Combine> T combine_pairwise(std::vector<T>& items, const Combine& combine) {
    for (std::size_t count = items.size(); count > 1; count = (count + 1) / 2) {
        for (std::size_t i = 0; i + 1 < count; i += 2)
            items[i / 2] = combine(items[i], items[i + 1]);
        if (count % 2 == 1)
            items[count / 2] = std::move(items[count - 1]);
    }
    return std::move(items[0]);
}

} // namespace

Interpreter::Flow Interpreter::execute_photon_loop(const Statement& statement) {
    const PhotonLoop& loop = *m_plan.find(statement);
    LoopReport& report = m_outputs.find_loop(statement);
    ++report.runs;
    m_loop_prints = 0;
    m_loop_start = std::chrono::steady_clock::now();
    report.is_parallel = loop.is_parallel && m_run_pass && m_run_pass(loop, m_state, report);
    if (!report.is_parallel) {
        const std::uint64_t fuel = m_fuel;
        interpret_loop(loop, report);
        m_fuel = fuel;
        const auto spent = std::chrono::steady_clock::now() - m_loop_start;
        report.milliseconds += std::chrono::duration<double, std::milli>(spent).count();
    }
    VariableState& index = m_state.variables[statement.variable];
    index.numbers[0].integer = static_cast<std::int32_t>(m_photons.count);
    index.is_set = true;
    return Flow::on;
}

void Interpreter::list_reduced(const PhotonLoop& loop) {
    m_reduced.clear();
    for (const auto& [variable, use] : loop.variables)
        if (is_reduction(use.role)) {
            m_reduced.push_back(variable);
            m_is_reduced[variable] = true;
        }
}

Interpreter::Lane Interpreter::make_lane(const PhotonLoop& loop) const {
    Lane lane;
    for (const std::uint32_t variable : m_reduced) {
        const Role role = loop.variables.at(variable).role;
        const std::size_t count = m_state.variables[variable].numbers.size();
        lane.values.emplace_back(count, find_identity(role, m_program.variables[variable].type));
        lane.photons.emplace_back(is_choice(role) ? count : 0, NO_PHOTON);
    }
    return lane;
}

// The body then works on the lane's own values.
void Interpreter::enter_lane(const PhotonLoop& loop, Lane& lane) {
    for (std::size_t i = 0; i < m_reduced.size(); ++i) {
        std::swap(m_state.variables[m_reduced[i]].numbers, lane.values[i]);
        std::swap(m_choice_photons[m_reduced[i]], lane.photons[i]);
    }
    if (loop.pca_2d == AccumulatorUse::reduction)
        std::swap(m_state.pca_2d, lane.pca_2d);
    if (loop.pca_3d == AccumulatorUse::reduction)
        std::swap(m_state.pca_3d, lane.pca_3d);
}

void Interpreter::leave_lane(const PhotonLoop& loop, Lane& lane) { enter_lane(loop, lane); }

Interpreter::Lane Interpreter::combine_lanes(const PhotonLoop& loop, std::vector<Lane>& lanes) const {
    return combine_pairwise(lanes, [&](const Lane& a, const Lane& b) {
        Lane joined = a;
        for (std::size_t i = 0; i < m_reduced.size(); ++i) {
            const VariableUse& use = loop.variables.at(m_reduced[i]);
            const Type type = m_program.variables[m_reduced[i]].type;
            for (std::size_t j = 0; j < joined.values[i].size(); ++j) {
                if (use.role == Role::payload)
                    continue; // goes with its choice, below
                if (!is_choice(use.role)) {
                    joined.values[i][j] = combine(use.role, type, a.values[i][j], b.values[i][j]);
                    continue;
                }
                const Choice mine{a.values[i][j], a.photons[i][j]}, other{b.values[i][j], b.photons[i][j]};
                if (!wins(use.role, type, other, mine))
                    continue;
                joined.values[i][j] = other.value;
                joined.photons[i][j] = other.photon;
                for (std::size_t p = 0; p < m_reduced.size(); ++p) {
                    const VariableUse& payload = loop.variables.at(m_reduced[p]);
                    if (payload.role == Role::payload && payload.of == m_reduced[i])
                        joined.values[p][j] = b.values[p][j];
                }
            }
        }
        joined.pca_2d = merge_moments(a.pca_2d, b.pca_2d);
        joined.pca_3d = merge_moments(a.pca_3d, b.pca_3d);
        return joined;
    });
}

void Interpreter::interpret_loop(const PhotonLoop& loop, LoopReport& report) {
    list_reduced(loop);
    std::vector<Lane> blocks, lanes;
    for (std::uint32_t photon = 0; photon < m_photons.count; ++photon) {
        if (photon % REDUCTION_BLOCK == 0) {
            m_progress.report("run script", static_cast<double>(photon) / m_photons.count);
            check_time(report);
            lanes.assign(REDUCTION_LANES, make_lane(loop));
        }
        Lane& lane = lanes[photon % REDUCTION_LANES];
        enter_lane(loop, lane);
        const Flow flow = report.stopped.empty() ? iterate(loop, photon, report) : Flow::leave;
        leave_lane(loop, lane);
        const bool is_last = photon + 1 == m_photons.count || flow == Flow::leave;
        if (is_last || (photon + 1) % REDUCTION_BLOCK == 0)
            blocks.push_back(combine_lanes(loop, lanes));
        if (flow == Flow::leave)
            break;
    }
    if (!blocks.empty())
        bring_back(loop, combine_lanes(loop, blocks));
    for (const std::uint32_t variable : m_reduced)
        m_is_reduced[variable] = false;
    m_reduced.clear();
    m_iteration = {};
}

// The value a variable had before the loop, combined with the loop's total.
void Interpreter::bring_back(const PhotonLoop& loop, const Lane& total) {
    for (std::size_t i = 0; i < m_reduced.size(); ++i) {
        const VariableUse& use = loop.variables.at(m_reduced[i]);
        VariableState& state = m_state.variables[m_reduced[i]];
        const Type type = m_program.variables[m_reduced[i]].type;
        for (std::size_t j = 0; j < state.numbers.size(); ++j) {
            const Number before = state.numbers[j];
            if (use.role == Role::payload)
                continue;
            if (!is_choice(use.role)) {
                state.numbers[j] = combine(use.role, type, before, total.values[i][j]);
                continue;
            }
            if (!wins(use.role, type, {total.values[i][j], total.photons[i][j]}, {before, 0}))
                continue;
            state.numbers[j] = total.values[i][j];
            for (std::size_t p = 0; p < m_reduced.size(); ++p) {
                const VariableUse& payload = loop.variables.at(m_reduced[p]);
                if (payload.role == Role::payload && payload.of == m_reduced[i]) {
                    m_state.variables[m_reduced[p]].numbers[j] = total.values[p][j];
                    m_state.variables[m_reduced[p]].is_set = true;
                }
            }
        }
    }
    m_state.pca_2d = merge_moments(m_state.pca_2d, total.pca_2d);
    m_state.pca_3d = merge_moments(m_state.pca_3d, total.pca_3d);
}

Interpreter::Flow Interpreter::iterate(const PhotonLoop& loop, std::uint32_t photon, LoopReport& report) {
    m_iteration = {};
    m_iteration.loop = &loop;
    m_iteration.photon = photon;
    m_iteration.parameters.resize(PARAMETER_LIMIT);
    m_iteration.has_parameter.resize(PARAMETER_LIMIT);
    m_fuel = m_settings.fuel;
    VariableState& index = m_state.variables[loop.statement->variable];
    index.numbers[0].integer = static_cast<std::int32_t>(photon);
    index.is_set = true;
    const Moments before_2d = m_state.pca_2d, before_3d = m_state.pca_3d;
    try {
        const Flow flow = execute(loop.statement->body);
        commit_iteration();
        return flow == Flow::leave ? flow : Flow::on;
    } catch (const OutOfFuel& out) {
        take_back();
        if (loop.pca_2d == AccumulatorUse::reduction)
            m_state.pca_2d = before_2d;
        if (loop.pca_3d == AccumulatorUse::reduction)
            m_state.pca_3d = before_3d;
        note_exhausted(report, photon, out.at);
        return Flow::on;
    }
}

void Interpreter::take_back() {
    for (auto undo = m_iteration.undo.rbegin(); undo != m_iteration.undo.rend(); ++undo) {
        m_state.variables[undo->variable].numbers[undo->element] = undo->before;
        if (!m_choice_photons[undo->variable].empty())
            m_choice_photons[undo->variable][undo->element] = undo->photon;
    }
}

void Interpreter::note_exhausted(LoopReport& report, std::uint32_t photon, Span at) {
    if (report.exhausted++ == 0) {
        report.first_exhausted = photon;
        report.exhausted_at = at;
    }
    if (report.exhausted >= m_settings.most_exhausted)
        report.stopped = std::to_string(report.exhausted) + " photons ran out of steps; the rest were left out";
}

void Interpreter::check_time(LoopReport& report) {
    const auto spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - m_loop_start).count();
    if (spent > m_settings.most_seconds)
        report.stopped = "it took longer than " + std::to_string(std::lround(m_settings.most_seconds)) +
                         " s; the rest of the photons were left out";
}

void Interpreter::commit_iteration() {
    if (m_is_replay) {
        m_replayed = std::move(m_iteration.prints);
        return;
    }
    ScriptColumns& columns = m_outputs.columns;
    const std::uint32_t photon = m_iteration.photon;
    for (std::size_t i = 0; i < columns.declared().size(); ++i)
        if (m_iteration.has_parameter[i])
            columns.write_parameter(i, photon, m_iteration.parameters[i]);
    if (m_iteration.has_color)
        columns.write_color(photon, m_iteration.color);
    for (const Iteration::Sample& sample : m_iteration.samples)
        m_outputs.histograms[sample.histogram].add(sample.value);
    for (std::string& line : m_iteration.prints)
        if (m_loop_prints++ < PRINT_LIMIT)
            m_outputs.prints.push_back(std::move(line));
}

void Interpreter::replay_photon(const PhotonLoop& loop, std::uint32_t photon, std::vector<std::string>& prints) {
    const ScriptState kept = m_state;
    m_is_replay = true;
    LoopReport unused;
    list_reduced(loop);
    Lane lane = make_lane(loop);
    enter_lane(loop, lane);
    m_replayed.clear();
    iterate(loop, photon, unused);
    prints.insert(prints.end(), m_replayed.begin(), m_replayed.end());
    for (const std::uint32_t variable : m_reduced) {
        m_is_reduced[variable] = false;
        m_choice_photons[variable].clear();
    }
    m_reduced.clear();
    m_iteration = {};
    m_is_replay = false;
    m_state = kept;
}

} // namespace photonloupe::script
