// SPDX-License-Identifier: Apache-2.0
// What a pass is brought before it runs, and what is fetched from it afterwards.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "script/run/pass_work.h"

namespace photonloupe::script {
namespace {

constexpr std::uint32_t WORD_BITS = 32;

std::uint32_t to_word(float value) {
    return std::bit_cast<std::uint32_t>(value);
}

float to_real(const Expression& expression, Number value) {
    return expression.type == Type::integer ? static_cast<float>(value.integer) : value.real;
}

void store_decomposition(const Decomposition& found, std::span<std::uint32_t> words) {
    words[0] = static_cast<std::uint32_t>(found.dimensions);
    for (std::size_t i = 0; i < 3; ++i) {
        words[1 + i] = to_word(found.eigenvalues[i]);
        for (std::size_t axis = 0; axis < 3; ++axis)
            words[4 + 3 * i + axis] = to_word(found.eigenvectors[i][axis]);
        words[13 + i] = to_word(found.mean[i]);
    }
}

std::string describe_space(NeighborQuery::Space space) {
    return space == NeighborQuery::Space::world       ? "getKNN"
           : space == NeighborQuery::Space::parameter ? "getParameterKNN"
                                                      : "getConstrainedKNN";
}

} // namespace

void PassRunner::fill_uniforms(Work& work) const {
    const ScriptState& state = work.interpreter.state();
    const EmittedPass& pass = work.pass;
    work.uniforms.assign(pass.uniform_word_count, 0u);
    const std::span<std::uint32_t> words(work.uniforms);
    for (const UniformSlot& slot : pass.uniforms) {
        const VariableState& variable = state.variables[slot.variable];
        if (m_program.variables[slot.variable].type != Type::list)
            for (std::size_t i = 0; i < variable.numbers.size(); ++i)
                words[slot.first_word + i] = std::bit_cast<std::uint32_t>(variable.numbers[i]);
        if (slot.set_word)
            words[*slot.set_word] = variable.is_set;
    }
    if (pass.moments_2d_word)
        store_moments(state.pca_2d, words.subspan(*pass.moments_2d_word));
    if (pass.moments_3d_word)
        store_moments(state.pca_3d, words.subspan(*pass.moments_3d_word));
    if (pass.decomposition_word)
        store_decomposition(state.decomposition, words.subspan(*pass.decomposition_word));
    std::uint32_t next = 0;
    for (const PassHistogram& histogram : pass.histograms) {
        const float low = to_real(histogram.low, work.interpreter.evaluate_uniform(histogram.low));
        const float high = to_real(histogram.high, work.interpreter.evaluate_uniform(histogram.high));
        float bins = DEFAULT_BINS;
        if (histogram.bins)
            bins = to_real(*histogram.bins, work.interpreter.evaluate_uniform(*histogram.bins));
        const bool is_valid =
            low < high && std::isfinite(high - low) && bins >= 1 && bins <= MOST_BINS && bins == std::trunc(bins);
        const std::uint32_t count = is_valid ? static_cast<std::uint32_t>(bins) : 0u;
        const std::uint32_t described[] = {to_word(low), to_word(high), count, next};
        std::ranges::copy(described, words.begin() + histogram.first_word);
        next += is_valid ? count + shared::HISTOGRAM_EXTRA : 0u;
    }
    if (next > 0)
        work.histogram_words = gpu::make_buffer(m_device, std::vector<std::uint32_t>(next), "script histograms");
    for (const PassQuery& query : pass.queries) { // their k is known before any row is
        float k = DEFAULT_NEIGHBORS;
        if (query.query->count)
            k = to_real(*query.query->count, work.interpreter.evaluate_uniform(*query.query->count));
        const bool is_valid = k >= 1 && k <= float{MOST_NEIGHBORS} && k == std::trunc(k);
        words[query.first_word + 1] = is_valid ? static_cast<std::uint32_t>(k) : 0u;
    }
}

// Rows for the photons of a batch, and of all photons where others' are asked for.
void PassRunner::ask_neighbors(Work& work, std::uint32_t first_photon, std::uint32_t photon_count) const {
    struct Rows {
        gpu::Buffer ids;
        std::uint64_t words;
    };
    std::vector<Rows> parts;
    std::uint64_t next = 0;
    for (const PassQuery& query : work.pass.queries) {
        const bool is_near = query.query->is_at_loop_photon;
        const std::uint32_t first = is_near ? first_photon : 0;
        const std::uint32_t count = is_near ? photon_count : static_cast<std::uint32_t>(m_photons.count);
        const std::uint32_t k = work.uniforms[query.first_word + 1];
        float beta = 0;
        if (query.query->beta)
            beta = to_real(*query.query->beta, work.interpreter.evaluate_uniform(*query.query->beta));
        const bool is_valid = k > 0 && beta >= 0; // else the pass says so
        const std::uint32_t described[] = {static_cast<std::uint32_t>(next), is_valid ? k : 0u, first,
                                           is_valid ? count : 0u};
        std::ranges::copy(described, work.uniforms.begin() + query.first_word);
        if (!is_valid || count == 0)
            continue;
        std::vector<std::uint32_t> photons(count);
        std::iota(photons.begin(), photons.end(), first);
        Rows& rows =
            parts.emplace_back(Rows{m_find_rows(query.query->space, photons, k, beta), std::uint64_t{count} * k});
        next += rows.words;
        if (next > INT32_MAX)
            throw MemoryError(describe_space(query.query->space) + " of photons other than the loop's needs " +
                              std::to_string(next) +
                              " ids, more than 2^31; ask for fewer neighbours, or for those of "
                              "the loop's own photon");
    }
    std::vector<std::int32_t> lists; // of uniform variables
    for (const UniformSlot& slot : work.pass.uniforms) {
        if (m_program.variables[slot.variable].type != Type::list)
            continue;
        const std::vector<std::int32_t>& list = work.interpreter.state().variables[slot.variable].list;
        work.uniforms[slot.first_word] = static_cast<std::uint32_t>(next + lists.size());
        work.uniforms[slot.first_word + 1] = static_cast<std::uint32_t>(list.size());
        lists.insert(lists.end(), list.begin(), list.end());
    }
    if (next + lists.size() > 0) {
        work.neighbor_rows = gpu::Buffer(m_device, (next + lists.size()) * sizeof(std::int32_t), "neighbor lists");
        gpu::Commands copy(m_device, "run script");
        std::uint64_t offset = 0;
        for (const Rows& rows : parts) {
            copy.copy(rows.ids, 0, work.neighbor_rows, offset, rows.words * sizeof(std::int32_t));
            offset += rows.words * sizeof(std::int32_t);
        }
        copy.run();
        if (!lists.empty())
            work.neighbor_rows.upload(lists.data(), lists.size() * sizeof(std::int32_t), offset);
    }
    work.uniform_words = work.uniforms.empty() ? gpu::Buffer(m_device, sizeof(std::uint32_t), "script values")
                                               : gpu::make_buffer(m_device, work.uniforms, "script values");
}

void PassRunner::collect(Work& work) {
    ScriptColumns& columns = m_outputs.columns;
    if (work.loop.sets_parameters || work.loop.sets_colors)
        columns.note_device_wrote();
    if (work.loop.sets_colors)
        columns.note_colors();
    collect_sites(work);
    collect_histograms(work);
    if (work.loop.prints)
        collect_prints(work);
    if (work.pass.lanes.slots > 0)
        bring_back(work.pass.lanes, combine_blocks(work.pass.lanes, work.blocks), work.interpreter.state());
    const auto spent = std::chrono::steady_clock::now() - work.start;
    work.report.milliseconds += std::chrono::duration<double, std::milli>(spent).count();
}

void PassRunner::collect_sites(Work& work) {
    const std::vector<std::uint32_t> words =
        work.fault_words.read<std::uint32_t>(shared::FAULT_STRIDE * work.pass.sites.size());
    for (std::size_t i = 0; i < work.pass.sites.size(); ++i) {
        const PassSite& site = work.pass.sites[i];
        const std::uint32_t count = words[shared::FAULT_STRIDE * i], first = words[shared::FAULT_STRIDE * i + 1];
        if (count == 0)
            continue;
        if (!site.loop) {
            m_outputs.add_faults(site.fault, first, count);
            continue;
        }
        work.report.exhausted += count;
        if (first < work.report.first_exhausted) {
            work.report.first_exhausted = first;
            work.report.exhausted_at = site.loop->span;
        }
    }
}

void PassRunner::collect_histograms(const Work& work) {
    if (work.histogram_words.is_empty())
        return;
    const std::vector<std::uint32_t> words =
        work.histogram_words.read<std::uint32_t>(work.histogram_words.size_bytes() / sizeof(std::uint32_t));
    for (const PassHistogram& histogram : work.pass.histograms) {
        const std::uint32_t* described = &work.uniforms[histogram.first_word];
        const std::uint32_t bins = described[2], first = described[3];
        const auto counted = words.begin() + first;
        if (bins == 0 || std::all_of(counted, counted + bins + shared::HISTOGRAM_EXTRA, [](auto n) { return n == 0; }))
            continue; // nobody asked for it
        const std::size_t place = m_outputs.find_histogram(histogram.name, std::bit_cast<float>(described[0]),
                                                           std::bit_cast<float>(described[1]), bins);
        HistogramCounts& counts = m_outputs.histograms[place];
        for (std::uint32_t bin = 0; bin < bins; ++bin)
            counts.counts[bin] += words[first + bin];
        counts.below += words[first + bins];
        counts.above += words[first + bins + 1];
        counts.non_finite += words[first + bins + 2];
    }
}

// The lines of the first photons that print, as the interpreter writes them.
void PassRunner::collect_prints(Work& work) {
    const std::vector<std::uint32_t> words = work.print_bits.read<std::uint32_t>(m_photons.count / WORD_BITS + 1);
    std::vector<std::string> lines;
    for (std::uint32_t photon = 0; photon < m_photons.count && lines.size() < PRINT_LIMIT; ++photon)
        if (words[photon / WORD_BITS] >> photon % WORD_BITS & 1u)
            work.interpreter.replay_photon(work.loop, photon, lines);
    lines.resize(std::min<std::size_t>(lines.size(), PRINT_LIMIT));
    m_outputs.prints.insert(m_outputs.prints.end(), lines.begin(), lines.end());
}

} // namespace photonloupe::script
