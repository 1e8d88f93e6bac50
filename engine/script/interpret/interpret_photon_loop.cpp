// SPDX-License-Identifier: Apache-2.0
// Photon loops in the interpreter: iterations that stage what they write, and reductions in blocks and lanes.
#include <bit>
#include <cmath>

#include "script/interpret/interpreter.h"
#include "script/reference_math.h"

namespace photonloupe::script {
Interpreter::Flow Interpreter::execute_photon_loop(const Statement& statement) {
    const PhotonLoop& loop = *m_plan.find(statement);
    LoopReport& report = m_outputs.find_loop(statement);
    ++report.runs;
    m_loop_prints = 0;
    m_loop_start = std::chrono::steady_clock::now();
    report.is_parallel = loop.is_parallel && m_run_pass && m_run_pass(loop, *this, report);
    Flow flow = Flow::on;
    if (!report.is_parallel) {
        const std::uint64_t fuel = m_fuel;
        flow = interpret_loop(loop, report);
        m_fuel = fuel;
        const auto spent = std::chrono::steady_clock::now() - m_loop_start;
        report.milliseconds += std::chrono::duration<double, std::milli>(spent).count();
    }
    if (flow == Flow::on) {
        VariableState& index = m_state.variables[statement.variable];
        index.numbers[0].integer = static_cast<std::int32_t>(m_photons.count);
        index.is_set = true;
    }
    return flow == Flow::give ? flow : Flow::on;
}

void Interpreter::begin_reductions(const PhotonLoop& loop) {
    m_layout = lay_out_lanes(m_program, loop);
    for (const ReducedSlots& slots : m_layout.variables)
        m_is_reduced[slots.variable] = true;
}

void Interpreter::end_reductions() {
    for (const ReducedSlots& slots : m_layout.variables) {
        m_is_reduced[slots.variable] = false;
        m_choice_photons[slots.variable].clear();
    }
    m_layout = {};
    m_iteration = {};
}

Interpreter::Lane Interpreter::make_lane() const {
    Lane lane;
    for (const ReducedSlots& slots : m_layout.variables) {
        lane.values.emplace_back(slots.size, find_identity(slots.role, slots.type));
        lane.photons.emplace_back(is_choice(slots.role) ? slots.size : 0, NO_PHOTON);
    }
    return lane;
}

void Interpreter::swap_lane(Lane& lane) {
    for (std::size_t i = 0; i < m_layout.variables.size(); ++i) {
        const std::uint32_t variable = m_layout.variables[i].variable;
        std::swap(m_state.variables[variable].numbers, lane.values[i]);
        std::swap(m_choice_photons[variable], lane.photons[i]);
    }
    if (m_layout.pca_2d)
        std::swap(m_state.pca_2d, lane.pca_2d);
    if (m_layout.pca_3d)
        std::swap(m_state.pca_3d, lane.pca_3d);
}

std::vector<std::uint32_t> Interpreter::combine_block(const std::vector<Lane>& lanes) const {
    const std::size_t width = lanes.size();
    std::vector<std::uint32_t> words(m_layout.slots * width);
    for (std::size_t lane = 0; lane < width; ++lane) {
        for (std::size_t i = 0; i < m_layout.variables.size(); ++i) {
            const std::size_t first = m_layout.variables[i].first, size = m_layout.variables[i].size;
            for (std::size_t j = 0; j < size; ++j)
                words[(first + j) * width + lane] = std::bit_cast<std::uint32_t>(lanes[lane].values[i][j]);
            for (std::size_t j = 0; j < lanes[lane].photons[i].size(); ++j)
                words[(first + size + j) * width + lane] = lanes[lane].photons[i][j];
        }
        for (const auto& [first, moments] :
             {std::pair{m_layout.pca_2d, &lanes[lane].pca_2d}, std::pair{m_layout.pca_3d, &lanes[lane].pca_3d}}) {
            std::uint32_t packed[sizeof(Moments) / sizeof(std::uint32_t)];
            store_moments(*moments, packed);
            for (std::size_t j = 0; first && j < std::size(packed); ++j)
                words[(*first + j) * width + lane] = packed[j];
        }
    }
    return combine_lanes(m_layout, words, static_cast<std::uint32_t>(width));
}

Interpreter::Flow Interpreter::interpret_loop(const PhotonLoop& loop, LoopReport& report) {
    bool is_steady = true; // else the body decides which photon comes next
    visit_expressions(loop.statement->body, [&](const Expression& expression) {
        is_steady &= expression.kind != Expression::Kind::assignment || expression.variable != loop.statement->variable;
    });
    begin_reductions(loop);
    const Flow flow = is_steady ? interpret_in_order(loop, report) : interpret_as_written(loop, report);
    end_reductions();
    return flow;
}

Interpreter::Flow Interpreter::interpret_in_order(const PhotonLoop& loop, LoopReport& report) {
    std::vector<std::vector<std::uint32_t>> blocks;
    std::vector<Lane> lanes;
    Flow flow = Flow::on;
    for (std::uint32_t photon = 0; photon < m_photons.count && flow == Flow::on; ++photon) {
        if (photon % REDUCTION_BLOCK == 0) {
            m_fraction = static_cast<double>(photon) / m_photons.count;
            m_progress.report("run script", m_fraction);
            lanes.assign(REDUCTION_LANES, make_lane());
        }
        Lane& lane = lanes[photon % REDUCTION_LANES];
        swap_lane(lane);
        flow = iterate(loop, photon, report);
        swap_lane(lane);
        const bool is_last = photon + 1 == m_photons.count || flow != Flow::on || !report.stopped.empty();
        if (m_layout.slots > 0 && (is_last || (photon + 1) % REDUCTION_BLOCK == 0))
            blocks.push_back(combine_block(lanes));
        if (!report.stopped.empty())
            break;
    }
    if (!blocks.empty())
        bring_back(m_layout, combine_blocks(m_layout, blocks), m_state);
    return flow;
}

// There are no blocks of consecutive photons: everything is done in the order in which it comes.
Interpreter::Flow Interpreter::interpret_as_written(const PhotonLoop& loop, LoopReport& report) {
    VariableState& index = m_state.variables[loop.statement->variable];
    const auto count = static_cast<std::int32_t>(m_photons.count);
    Flow flow = Flow::on;
    std::int32_t next = 0;
    while (next < count && flow == Flow::on && report.stopped.empty()) {
        flow = iterate(loop, static_cast<std::uint32_t>(next), report);
        next = flow == Flow::on ? add_wrapping(index.numbers[0].integer, 1) : next;
    }
    return flow;
}

Interpreter::Flow Interpreter::iterate(const PhotonLoop& loop, std::uint32_t photon, LoopReport& report) {
    m_iteration = {};
    m_iteration.loop = &loop;
    m_iteration.photon = photon < m_photons.count ? photon : NO_PHOTON;
    m_iteration.parameters.resize(PARAMETER_LIMIT);
    m_iteration.has_parameter.resize(PARAMETER_LIMIT);
    m_fuel = m_settings.fuel;
    VariableState& index = m_state.variables[loop.statement->variable];
    index.numbers[0].integer = static_cast<std::int32_t>(photon);
    index.is_set = true;
    const Moments before_2d = m_state.pca_2d, before_3d = m_state.pca_3d;
    const auto undo = [&] {
        take_back();
        if (loop.pca_2d == AccumulatorUse::reduction)
            m_state.pca_2d = before_2d;
        if (loop.pca_3d == AccumulatorUse::reduction)
            m_state.pca_3d = before_3d;
        index.numbers[0].integer = static_cast<std::int32_t>(photon);
    };
    try {
        count_step();
        const Flow flow = execute(loop.statement->body);
        commit_iteration();
        return flow == Flow::next ? Flow::on : flow;
    } catch (const OutOfFuel& out) {
        undo();
        note_exhausted(report, photon, out.at);
    } catch (const OutOfTime&) {
        undo();
        check_time(report);
    }
    return Flow::on;
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

bool Interpreter::is_over_time() const {
    const auto spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - m_loop_start).count();
    return spent > m_settings.most_seconds;
}

void Interpreter::check_time(LoopReport& report) {
    if (is_over_time())
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

void Interpreter::iterate_photons(const PhotonLoop& loop, const std::vector<std::uint32_t>& photons,
                                  LoopReport& report) {
    const std::uint64_t fuel = m_fuel;
    const ScriptState kept = m_state; // locals hold nothing afterwards
    begin_reductions(loop);
    for (const std::uint32_t photon : photons) {
        check_time(report);
        if (!report.stopped.empty())
            break;
        m_progress.report("run script", 0.0);
        iterate(loop, photon, report);
    }
    end_reductions();
    m_state = kept;
    m_fuel = fuel;
}

void Interpreter::replay_photon(const PhotonLoop& loop, std::uint32_t photon, std::vector<std::string>& prints) {
    const ScriptState kept = m_state;
    m_is_replay = true;
    m_replayed.clear();
    LoopReport unused;
    begin_reductions(loop);
    Lane lane = make_lane();
    swap_lane(lane);
    iterate(loop, photon, unused);
    prints.insert(prints.end(), m_replayed.begin(), m_replayed.end());
    end_reductions();
    m_is_replay = false;
    m_state = kept;
}

} // namespace photonloupe::script
