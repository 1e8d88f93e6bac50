// SPDX-License-Identifier: Apache-2.0
// A pass from start to end: buffers, batches of blocks, dispatches cut by measured time, limits.
#include "script/run/pass_runner.h"

#include <algorithm>
#include <cmath>

#include "script/run/pass_work.h"

namespace photonloupe::script {
namespace {

constexpr const char* STAGE = "run script";
// Loop turns of one lane in one dispatch: half of what the strictest device allows (shaders/shared/turns.glsl).
constexpr std::uint32_t COMFORTABLE_TURNS = 30'000;
// Words of lanes that one batch of blocks may have, and of neighbours' rows.
constexpr std::uint64_t MOST_LANE_WORDS = 1ull << 24;
constexpr std::uint64_t MOST_ROW_WORDS = 1ull << 26;
// Rounds in a row where nothing is reduced: enough for what a lane does once, few enough for many lanes.
constexpr std::uint32_t MOST_FREE_ROUNDS = 16;
constexpr std::uint32_t WORD_BITS = 32;

template <class Words>
gpu::Buffer make_words(gpu::Device& device, const Words& words, const char* purpose) {
    return words.empty() ? gpu::Buffer(device, sizeof(std::uint32_t), purpose)
                         : gpu::make_buffer(device, words, purpose);
}

std::uint32_t count_blocks(std::uint64_t photons) {
    return static_cast<std::uint32_t>((photons + REDUCTION_BLOCK - 1) / REDUCTION_BLOCK);
}

} // namespace

gpu::KernelSource name_kernel(const EmittedPass& pass) {
    return {"script", REDUCTION_LANES, {}, {}, pass.glsl};
}

PassRunner::PassRunner(gpu::Device& device, const PhotonMap& photons, const Program& program, const Plan& plan,
                       const std::vector<EmittedPass>& passes, RunOutputs& outputs, const RunSettings& settings,
                       FindRows find_rows, const Progress& progress)
    : m_device(device), m_photons(photons), m_program(program), m_plan(plan), m_passes(passes), m_outputs(outputs),
      m_settings(settings), m_find_rows(std::move(find_rows)), m_progress(progress),
      m_columns(device, photons.count, outputs.columns), m_nothing(device, sizeof(glm::vec4), "nothing") {
    std::vector<gpu::KernelSource> kernels;
    for (const EmittedPass& pass : passes)
        if (!pass.glsl.empty())
            kernels.push_back(name_kernel(pass));
    device.compile_ahead(kernels);
}

bool PassRunner::run(const PhotonLoop& loop, Interpreter& interpreter, LoopReport& report) {
    const std::size_t index = static_cast<std::size_t>(&loop - m_plan.loops.data());
    Work work{loop, m_passes[index], interpreter, report};
    m_columns.prepare();
    const bool may_repeat = loop.sets_parameters && loop.reads_own_parameters;
    if (may_repeat && !m_columns.parameters().is_empty()) {
        work.kept_parameters = gpu::Buffer(m_device, m_columns.parameters().size_bytes(), "script parameters");
        gpu::copy(m_device, STAGE, m_columns.parameters(), work.kept_parameters, m_columns.parameters().size_bytes());
    }
    bool is_done = false;
    try {
        is_done = run_rounds(work);
    } catch (const Cancelled&) {
        if (work.report.stopped.empty())
            throw;
        is_done = true; // a limit was reached; what was done stays
    }
    if (is_done)
        collect(work);
    return is_done;
}

// Some rounds of a block in each dispatch; where a lane ran out of turns, all again, a round at a time.
bool PassRunner::run_rounds(Work& work) {
    start_anew(work);
    const auto photons = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(std::uint64_t{choose_batch(work)} * REDUCTION_BLOCK, m_photons.count));
    ask_neighbors(work, 0, photons);
    work.rounds = measure_rounds(work);
    run_blocks(work);
    if (work.has_late_photons && work.rounds > 1) {
        restore_columns(work);
        start_anew(work);
        ask_neighbors(work, 0, photons);
        work.rounds = 1;
        run_blocks(work);
    }
    return !work.has_late_photons || take_late_photons(work);
}

// As before the first dispatch.
void PassRunner::start_anew(Work& work) const {
    const std::uint32_t photon_words = static_cast<std::uint32_t>(m_photons.count / WORD_BITS + 1);
    std::vector<std::uint32_t> faults;
    for (std::size_t site = 0; site < work.pass.sites.size(); ++site)
        faults.insert(faults.end(), {0u, NO_PHOTON});
    work.fault_words = make_words(m_device, faults, "script faults");
    work.print_bits = make_words(m_device, std::vector<std::uint32_t>(photon_words), "script prints");
    work.late_bits = make_words(m_device, std::vector<std::uint32_t>(photon_words), "late photons");
    work.status_words = make_words(m_device, std::vector<std::uint32_t>(shared::STATUS_WORDS), "script status");
    work.blocks.clear();
    work.has_late_photons = false;
    fill_uniforms(work); // histograms too
}

void PassRunner::restore_columns(Work& work) const {
    if (work.kept_parameters.is_empty())
        return;
    gpu::copy(m_device, STAGE, work.kept_parameters, m_columns.parameters(), work.kept_parameters.size_bytes());
}

// Blocks whose lanes and rows fit together.
std::uint32_t PassRunner::choose_batch(const Work& work) const {
    std::uint64_t blocks = count_blocks(m_photons.count);
    if (work.pass.lanes.slots > 0)
        blocks = std::min(blocks, MOST_LANE_WORDS / (std::uint64_t{work.pass.lanes.slots} * REDUCTION_LANES));
    std::uint64_t row = 0;
    for (const PassQuery& query : work.pass.queries)
        row += query.query->is_at_loop_photon ? work.uniforms[query.first_word + 1] : 0;
    if (row > 0)
        blocks = std::min(blocks, MOST_ROW_WORDS / (row * REDUCTION_BLOCK));
    return static_cast<std::uint32_t>(std::max<std::uint64_t>(blocks, 1));
}

void PassRunner::dispatch(gpu::Commands& commands, const Work& work, const shared::ScriptPass& push,
                          std::uint32_t groups) const {
    const auto choose = [&](const gpu::Buffer& buffer) -> const gpu::Buffer& {
        return buffer.is_empty() ? m_nothing : buffer;
    };
    const auto choose_path = [&](gpu::Buffer PathColumns::* column) -> const gpu::Buffer& {
        return m_photons.paths ? choose((*m_photons.paths).*column) : m_nothing;
    };
    commands.dispatch(name_kernel(work.pass),
                      {{"uniform_words", work.uniform_words},
                       {"lane_words", choose(work.lane_words)},
                       {"fault_words", work.fault_words},
                       {"status_words", work.status_words},
                       {"histogram_words", choose(work.histogram_words)},
                       {"print_bits", work.print_bits},
                       {"late_bits", work.late_bits},
                       {"neighbor_rows", choose(work.neighbor_rows)},
                       {"parameter_columns", m_columns.parameters()},
                       {"colors", m_columns.colors()},
                       {"position_emitter", m_photons.position_emitter},
                       {"normal_index", m_photons.normal_index},
                       {"power_object", m_photons.power_object},
                       {"path_starts", choose_path(&PathColumns::starts)},
                       {"path_vertices", choose_path(&PathColumns::vertices)},
                       {"path_normals", choose_path(&PathColumns::normals)}},
                      push, std::uint64_t{push.block_count} * groups * REDUCTION_LANES);
}

// A first look at 64 photons that writes nothing: how many rounds of a block one dispatch can take.
std::uint32_t PassRunner::measure_rounds(Work& work) const {
    shared::ScriptPass push = work.push(m_photons, m_outputs, m_settings);
    push.block_count = push.rounds = 1;
    push.flags = shared::SCRIPT_IS_DRY;
    gpu::Commands commands(m_device, STAGE);
    dispatch(commands, work, push, 1);
    commands.run();
    const std::vector<std::uint32_t> status = work.status_words.read<std::uint32_t>(shared::STATUS_WORDS);
    const std::uint32_t turns = std::max(status[shared::STATUS_MOST_TURNS], 1u);
    work.status_words = make_words(m_device, std::vector<std::uint32_t>(shared::STATUS_WORDS), "script status");
    if (status[shared::STATUS_FLAGS])
        return 1;
    const std::uint32_t most = work.pass.lanes.slots > 0 ? shared::SCRIPT_ROUNDS : MOST_FREE_ROUNDS;
    return std::clamp(COMFORTABLE_TURNS / turns, 1u, most);
}

// Between dispatches. Sets report.stopped, has_late_photons. Late photons are the interpreter's as soon as they are
// many: a script that never ends is then stopped early.
void PassRunner::check_limits(Work& work) {
    work.has_late_photons = work.status_words.read<std::uint32_t>(1)[0] != 0;
    if (work.has_late_photons && work.rounds == 1 && can_hand_over(work) &&
        list_late_photons(work).size() >= m_settings.most_exhausted)
        take_late_photons(work);
    if (!work.report.stopped.empty())
        return;
    const std::vector<std::uint32_t> words =
        work.fault_words.read<std::uint32_t>(shared::FAULT_STRIDE * work.pass.sites.size());
    std::uint32_t exhausted = 0;
    for (std::size_t site = 0; site < work.pass.sites.size(); ++site)
        if (work.pass.sites[site].loop)
            exhausted += words[shared::FAULT_STRIDE * site];
    const auto spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - work.start).count();
    if (exhausted >= m_settings.most_exhausted)
        work.report.stopped = std::to_string(exhausted) + " photons ran out of steps; the rest were left out";
    else if (spent > m_settings.most_seconds)
        work.report.stopped = "it took longer than " + std::to_string(std::lround(m_settings.most_seconds)) +
                              " s; the rest of the photons were left out";
}

// Dispatches a batch.
void PassRunner::run_batch(Work& work, std::uint32_t first_block, std::uint32_t block_count) {
    if (work.pass.lanes.slots > 0) {
        const std::vector<std::uint32_t> identity = make_identity(work.pass.lanes);
        std::vector<std::uint32_t> words;
        words.reserve(std::size_t{block_count} * identity.size() * REDUCTION_LANES);
        for (std::uint32_t block = 0; block < block_count; ++block)
            for (const std::uint32_t word : identity)
                words.insert(words.end(), REDUCTION_LANES, word);
        work.lane_words = make_words(m_device, words, "script reductions");
    }
    const bool reduces = work.pass.lanes.slots > 0;
    const std::uint32_t dispatches = reduces ? (shared::SCRIPT_ROUNDS + work.rounds - 1) / work.rounds : 1;
    const std::uint32_t groups = reduces ? 1 : (shared::SCRIPT_ROUNDS + work.rounds - 1) / work.rounds;
    shared::ScriptPass push = work.push(m_photons, m_outputs, m_settings);
    push.lane_block = first_block;
    push.rounds = work.rounds;
    // Asked between chunks, while the device is free: whoever listens may want it.
    const Progress between{[&](std::string_view, double fraction) {
        if (fraction > 0)
            check_limits(work);
        m_progress.report(STAGE, (first_block + fraction * block_count) / count_blocks(m_photons.count));
        return work.report.stopped.empty() || fraction >= 1;
    }};
    const std::uint64_t most_blocks = m_device.limits().max_group_count / groups;
    gpu::run_in_chunks(
        m_device, STAGE, block_count, 1, between,
        [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
            push.first_block = first_block + static_cast<std::uint32_t>(first);
            push.block_count = static_cast<std::uint32_t>(count);
            for (std::uint32_t turn = 0; turn < dispatches; ++turn) {
                push.first_round = turn * work.rounds;
                dispatch(commands, work, push, groups);
            }
        },
        most_blocks);
}

void PassRunner::run_blocks(Work& work) {
    const std::uint32_t blocks = count_blocks(m_photons.count);
    const std::uint32_t batch = choose_batch(work);
    for (std::uint32_t first = 0; first < blocks && work.report.stopped.empty(); first += batch) {
        const std::uint32_t count = std::min(batch, blocks - first);
        const std::uint32_t first_photon = first * REDUCTION_BLOCK;
        const auto photons = static_cast<std::uint32_t>(
            std::min<std::uint64_t>(std::uint64_t{count} * REDUCTION_BLOCK, m_photons.count - first_photon));
        if (first > 0)
            ask_neighbors(work, first_photon, photons);
        run_batch(work, first, count);
        if (work.has_late_photons && (work.rounds > 1 || !can_hand_over(work)))
            return;
        if (work.pass.lanes.slots > 0) {
            const std::size_t size = std::size_t{work.pass.lanes.slots} * REDUCTION_LANES;
            const std::vector<std::uint32_t> words = work.lane_words.read<std::uint32_t>(count * size);
            for (std::uint32_t block = 0; block < count; ++block)
                work.blocks.push_back(
                    combine_lanes(work.pass.lanes, std::span(words).subspan(block * size, size), REDUCTION_LANES));
        }
    }
}

// Whether the interpreter can take single photons: where something is reduced in their order it takes the whole loop.
bool PassRunner::can_hand_over(const Work& work) const {
    return work.pass.lanes.slots == 0 && work.pass.can_miss_photons;
}

std::vector<std::uint32_t> PassRunner::list_late_photons(const Work& work) const {
    const std::vector<std::uint32_t> words = work.late_bits.read<std::uint32_t>(m_photons.count / WORD_BITS + 1);
    std::vector<std::uint32_t> late;
    for (std::uint32_t photon = 0; photon < m_photons.count; ++photon)
        if (words[photon / WORD_BITS] >> photon % WORD_BITS & 1u)
            late.push_back(photon);
    return late;
}

// Photons that need more loop turns than the device has.
bool PassRunner::take_late_photons(Work& work) {
    if (!can_hand_over(work)) {
        restore_columns(work);
        if (work.loop.sets_parameters || work.loop.sets_colors)
            m_outputs.columns.note_device_wrote();
        work.report.stopped.clear();
        return false;
    }
    if (work.loop.sets_parameters || work.loop.sets_colors)
        m_outputs.columns.note_device_wrote();
    if (work.loop.sets_colors)
        m_outputs.columns.note_colors();
    work.interpreter.iterate_photons(work.loop, list_late_photons(work), work.report);
    m_columns.prepare(); // what the interpreter wrote, for the dispatches to come
    gpu::Commands clear(m_device, STAGE);
    clear.fill(work.late_bits, 0);
    clear.fill(work.status_words, 0);
    clear.run();
    work.has_late_photons = false;
    return true;
}

} // namespace photonloupe::script
