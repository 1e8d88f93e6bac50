// SPDX-License-Identifier: Apache-2.0
// Traces photons chunk by chunk: shoot, count, decide how much of the chunk is kept, write, account.
#include "trace/trace_photons.h"

#include <algorithm>
#include <cstdio>

#include "core/settings.h"
#include "photons/growing_buffer.h"
#include "trace/chunk.h"

namespace photonloupe {
namespace {

constexpr std::uint32_t FIRST_CHUNK = 1u << 14;
// Chunks are halved above this multiple of the device's chunk time, and doubled below that one.
constexpr double SLOW_CHUNK = 2.0;
constexpr double FAST_CHUNK = 0.625;
// A scene whose first 64 blocks store nothing is given up (METHODS §1), and so is one that needs more than 2^30.
constexpr std::uint64_t EMPTY_BLOCK_LIMIT = 64;
// Paths a lane shoots in turn, so that none waits for the longest; all their loop turns come from one budget
// (shaders/shared/turns.glsl), so long paths go alone.
constexpr std::uint32_t PATHS_PER_LANE = 8;
constexpr std::uint32_t SHORT_PATH_BOUNCES = 24;
// Columns are reserved for what the first chunk leads to expect, and a little more; never for more than 2^26 rows
// ahead.
constexpr double EXPECTATION_MARGIN = 1.03;
constexpr std::uint64_t LARGEST_EXPECTATION = 1ull << 26;
constexpr std::uint64_t PHOTON_BYTES = 3 * sizeof(glm::vec4);

// What a trace dispatches, in this order.
struct TraceKernels {
    gpu::KernelSource shoot{"trace/shoot_photons.comp", 0, {}, {}};
    gpu::KernelSource count{"trace/count_photons.comp", 64, {}, {}};
    gpu::KernelSource scan{"trace/scan_blocks.comp", 0, {}, {}};
    gpu::KernelSource write{"trace/write_photons.comp", 64, {}, {}};
    gpu::KernelSource sum{"trace/sum_balance.comp", 64, {}, {}};
    gpu::KernelSource scale{"trace/scale_power.comp", 64, {}, {}};
};

class Tracer {
public:
    Tracer(gpu::Device& device, const Scene& scene, const SceneBuffers& buffers, const EmitterTable& emitters,
           const TraceSettings& settings)
        : m_device(device), m_scene(scene), m_buffers(buffers), m_settings(settings), m_table(emitters),
          m_emitters(gpu::make_buffer(device, m_table.emitters, "emitters")),
          m_cells(gpu::make_buffer(device, m_table.cells, "projection cells")),
          m_cell_rows(gpu::make_buffer(device, m_table.cell_rows, "projection rows")),
          m_slot_count(count_slots(scene, settings)) {
        m_kernels.shoot.defines = list_defines();
        if (settings.paths)
            m_kernels.write.defines.emplace_back("RECORD_PATHS");
        if (has_colored_emission(scene))
            m_kernels.sum.defines.emplace_back("HAS_COLORED_EMISSION");
    }

    TracedPhotons run(const Progress& progress);

private:
    std::vector<std::string> list_defines() const;
    void require_memory() const;
    void shoot_slowly();
    void choose_chunk(double milliseconds);
    double shoot();
    std::uint32_t find_kept_paths(const std::vector<glm::uvec2>& offsets) const;
    std::uint64_t expect_total(std::uint64_t so_far, std::uint32_t kept) const;
    void reserve(const glm::uvec2& added, std::uint32_t kept);
    void write(std::uint32_t kept, const glm::uvec2& added);
    bool account(std::uint32_t kept);
    bool is_done() const;
    void require_progress() const;
    void scale_power(const Progress& progress);
    TracedPhotons finish(const Progress& progress);
    double find_fraction() const;

    gpu::Device& m_device;
    const Scene& m_scene;
    const SceneBuffers& m_buffers;
    const TraceSettings& m_settings;
    const EmitterTable& m_table;
    gpu::Buffer m_emitters;
    gpu::Buffer m_cells;
    gpu::Buffer m_cell_rows;
    std::uint32_t m_slot_count;
    TraceKernels m_kernels;
    ChunkScratch m_scratch;
    shared::TraceSettings m_push{};
    std::uint32_t m_paths_per_lane = PATHS_PER_LANE;
    std::uint64_t m_photon_count = 0;
    std::uint64_t m_vertex_count = 0;
    GrowingBuffer m_position{m_device, "photon positions"};
    GrowingBuffer m_normal{m_device, "photon normals"};
    GrowingBuffer m_power{m_device, "photon powers"};
    GrowingBuffer m_starts{m_device, "path starts"};
    GrowingBuffer m_vertices{m_device, "path vertices"};
    GrowingBuffer m_normals{m_device, "path normals"};
    TraceReport m_report;
};

std::vector<std::string> Tracer::list_defines() const {
    std::vector<std::string> defines = list_scene_defines(m_scene);
    defines.push_back("STORE_MODE " + std::to_string(static_cast<std::uint32_t>(m_settings.store)));
    defines.push_back("EMISSION " + std::to_string(static_cast<std::uint32_t>(m_settings.emission)));
    if (m_settings.paths)
        defines.emplace_back("RECORD_PATHS");
    for (std::string& define : list_light_defines(m_scene))
        defines.push_back(std::move(define));
    if (has_colored_emission(m_scene))
        defines.emplace_back("HAS_COLORED_EMISSION");
    if (m_table.emitters.size() > 1)
        defines.emplace_back("HAS_SEVERAL_LIGHTS");
    return defines;
}

std::string describe_gigabytes(std::uint64_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f GB", static_cast<double>(bytes) * 1e-9);
    return text;
}

std::string describe_share(double share) {
    char text[32];
    std::snprintf(text, sizeof text, ", %.3g %% land", 100 * share);
    return text;
}

void Tracer::require_memory() const {
    if (m_settings.emitted)
        return; // how many will be stored is not known; each growth is checked
    const std::uint64_t needed = m_settings.count * PHOTON_BYTES;
    const std::uint64_t one = m_device.limits().max_allocation_bytes / sizeof(glm::vec4);
    const std::uint64_t fitting = std::min(m_device.available_bytes() / PHOTON_BYTES, one);
    if (m_settings.count > fitting)
        throw MemoryError("photon map: " + describe_gigabytes(needed) + " needed, " +
                          describe_gigabytes(fitting * PHOTON_BYTES) + " to be had on " + m_device.info().name + ": " +
                          std::to_string(fitting) + " photons fit, " + std::to_string(m_settings.count) +
                          " asked; ask for fewer");
}

void Tracer::choose_chunk(double milliseconds) {
    const std::uint32_t largest = find_largest_chunk(m_device.limits(), m_slot_count);
    std::uint32_t size = m_scratch.size == 0 ? std::min(FIRST_CHUNK, largest) : m_scratch.size;
    const double aim = m_device.chunk_milliseconds();
    if (milliseconds > SLOW_CHUNK * aim)
        size = std::max(size / 2, shared::EMISSION_BLOCK);
    else if (milliseconds > 0 && milliseconds < FAST_CHUNK * aim && m_report.emitted % (2 * size) == 0)
        size = std::min(2 * size, largest); // aligned, so that the lane order keeps its meaning
    if (size != m_scratch.size) {
        m_scratch = {}; // freed before the larger one is asked for
        m_scratch = allocate_chunk(m_device, size, m_slot_count, m_settings.emission, has_colored_emission(m_scene));
    }
    const std::uint64_t left = m_settings.emitted ? *m_settings.emitted - m_report.emitted : size;
    m_push.first = static_cast<std::uint32_t>(m_report.emitted);
    m_push.count = static_cast<std::uint32_t>(std::min<std::uint64_t>(size, left));
    m_push.seed = m_settings.seed;
    m_push.max_bounces = m_settings.max_bounces;
    m_push.slot_count = m_slot_count;
    m_push.light_count = static_cast<std::uint32_t>(m_table.emitters.size());
    m_push.chunk_size = size;
    m_push.paths_per_lane = m_settings.max_bounces <= SHORT_PATH_BOUNCES ? m_paths_per_lane : 1;
}

double Tracer::shoot() {
    const std::uint32_t blocks = (m_push.count + shared::PATHS_PER_BLOCK - 1) / shared::PATHS_PER_BLOCK;
    gpu::Commands commands(m_device, "trace photons");
    commands.dispatch(m_kernels.shoot,
                      m_buffers.bind({{"emitters", m_emitters},
                                      {"cells", m_cells},
                                      {"cell_rows", m_cell_rows},
                                      {"lane_order", m_scratch.lane_order},
                                      {"summaries", m_scratch.summaries},
                                      {"deposited_flux", m_scratch.deposited_flux},
                                      {"lost_flux", m_scratch.lost_flux},
                                      {"emitted_flux", m_scratch.emitted_flux},
                                      {"scratch_position", m_scratch.position},
                                      {"scratch_normal", m_scratch.normal},
                                      {"scratch_power", m_scratch.power}}),
                      m_push, m_push.chunk_size / m_push.paths_per_lane);
    commands.dispatch(m_kernels.count,
                      {{"summaries", m_scratch.summaries},
                       {"path_offsets", m_scratch.path_offsets},
                       {"block_sums", m_scratch.block_sums}},
                      m_push, blocks);
    commands.dispatch(m_kernels.scan,
                      {{"block_sums", m_scratch.block_sums}, {"block_offsets", m_scratch.block_offsets}}, m_push, 1);
    return commands.run();
}

// All paths of the chunk, or up to the first whole emission block that reaches the count.
std::uint32_t Tracer::find_kept_paths(const std::vector<glm::uvec2>& offsets) const {
    if (m_settings.emitted)
        return m_push.count;
    constexpr std::uint32_t blocks_per_cut = shared::EMISSION_BLOCK / shared::PATHS_PER_BLOCK;
    for (std::uint32_t cut = blocks_per_cut; cut < offsets.size(); cut += blocks_per_cut)
        if (m_photon_count + offsets[cut].x >= m_settings.count)
            return cut * shared::PATHS_PER_BLOCK;
    return m_push.count;
}

// What a column will need in the end if the rest of the work is like the part done, so that columns seldom grow.
std::uint64_t Tracer::expect_total(std::uint64_t so_far, std::uint32_t kept) const {
    const double done = m_settings.emitted
                            ? static_cast<double>(m_report.emitted + kept) / static_cast<double>(*m_settings.emitted)
                            : static_cast<double>(so_far) / static_cast<double>(m_settings.count);
    const double expected = static_cast<double>(so_far) / std::clamp(done, 1e-6, 1.0) * EXPECTATION_MARGIN;
    return std::max(so_far, std::min(static_cast<std::uint64_t>(expected), LARGEST_EXPECTATION));
}

void Tracer::reserve(const glm::uvec2& added, std::uint32_t kept) {
    const std::uint64_t photons = m_photon_count + added.x;
    const std::uint64_t vertices = m_vertex_count + added.y;
    const std::uint64_t expected =
        m_settings.emitted ? expect_total(photons, kept) : std::max(photons, m_settings.count);
    for (GrowingBuffer* column : {&m_position, &m_normal, &m_power})
        if (column->buffer().size_bytes() < photons * sizeof(glm::vec4) || column->buffer().is_empty())
            column->reserve(expected * sizeof(glm::vec4), m_photon_count * sizeof(glm::vec4));
    if (!m_settings.paths)
        return;
    if (m_starts.buffer().size_bytes() < (photons + 1) * sizeof(std::uint32_t) || m_starts.buffer().is_empty())
        m_starts.reserve((expected + 1) * sizeof(std::uint32_t), m_photon_count * sizeof(std::uint32_t));
    const double per_photon = static_cast<double>(vertices) / static_cast<double>(std::max<std::uint64_t>(photons, 1));
    const auto more = static_cast<std::uint64_t>(per_photon * static_cast<double>(expected) * EXPECTATION_MARGIN);
    for (GrowingBuffer* column : {&m_vertices, &m_normals})
        if (column->buffer().size_bytes() < vertices * sizeof(glm::vec4) || column->buffer().is_empty())
            column->reserve(std::max(vertices, std::min(more, LARGEST_EXPECTATION)) * sizeof(glm::vec4),
                            m_vertex_count * sizeof(glm::vec4));
}

void Tracer::write(std::uint32_t kept, const glm::uvec2& added) {
    if (m_vertex_count + added.y > UINT32_MAX)
        throw MemoryError("path columns: more than 2^32 vertices; trace fewer photons, or without path columns");
    reserve(added, kept);
    m_push.count = kept;
    m_push.photon_base = static_cast<std::uint32_t>(m_photon_count);
    m_push.vertex_base = static_cast<std::uint32_t>(m_vertex_count);
    // Without paths the path bindings are not declared; any buffer may stand under their names.
    const gpu::Buffer& unused = m_emitters;
    gpu::Commands commands(m_device, "write photons");
    commands.dispatch(m_kernels.write,
                      {{"emitters", m_emitters},
                       {"summaries", m_scratch.summaries},
                       {"path_offsets", m_scratch.path_offsets},
                       {"block_offsets", m_scratch.block_offsets},
                       {"scratch_position", m_scratch.position},
                       {"scratch_normal", m_scratch.normal},
                       {"scratch_power", m_scratch.power},
                       {"position_emitter", m_position.buffer()},
                       {"normal_index", m_normal.buffer()},
                       {"power_object", m_power.buffer()},
                       {"path_starts", m_settings.paths ? m_starts.buffer() : unused},
                       {"path_vertices", m_settings.paths ? m_vertices.buffer() : unused},
                       {"path_normals", m_settings.paths ? m_normals.buffer() : unused}},
                      m_push, kept);
    commands.dispatch(m_kernels.sum,
                      {{"summaries", m_scratch.summaries},
                       {"deposited_flux", m_scratch.deposited_flux},
                       {"lost_flux", m_scratch.lost_flux},
                       {"emitted_flux", m_scratch.emitted_flux},
                       {"emitters", m_emitters},
                       {"balance", m_scratch.balance}},
                      m_push, (kept + shared::PATHS_PER_BLOCK - 1) / shared::PATHS_PER_BLOCK);
    commands.run();
}

// Adds the chunk's paths to the report; false when some were not finished, and then nothing is added.
bool Tracer::account(std::uint32_t kept) {
    const std::uint32_t blocks = (kept + shared::PATHS_PER_BLOCK - 1) / shared::PATHS_PER_BLOCK;
    const std::vector<shared::BalanceSum> sums = m_scratch.balance.read<shared::BalanceSum>(blocks);
    if (std::any_of(sums.begin(), sums.end(), [](const shared::BalanceSum& sum) { return sum.emitted.w > 0; }))
        return false;
    for (const shared::BalanceSum& sum : sums) {
        m_report.absorbed += sum.paths.x;
        m_report.escaped += sum.paths.y;
        m_report.truncated += sum.paths.z;
        m_report.ended_on_receiver += sum.paths.w;
        for (int channel = 0; channel < 3; ++channel) {
            m_report.flux_emitted[channel] += sum.emitted[channel];
            m_report.flux_deposited[channel] += sum.deposited[channel];
            m_report.flux_escaped[channel] += sum.escaped[channel];
            m_report.flux_truncated[channel] += sum.truncated[channel];
        }
    }
    m_report.emitted += kept;
    return true;
}

bool Tracer::is_done() const {
    return m_settings.emitted ? m_report.emitted >= *m_settings.emitted : m_photon_count >= m_settings.count;
}

void Tracer::require_progress() const {
    if (m_settings.emitted)
        return;
    const std::string where = m_scene.path.string() + ": ";
    if (m_photon_count == 0 && m_report.emitted >= EMPTY_BLOCK_LIMIT * shared::EMISSION_BLOCK)
        throw SceneError(where + "nothing was stored by the first " + std::to_string(m_report.emitted) +
                         " photons: " + std::to_string(m_report.escaped) + " escaped, " +
                         std::to_string(m_report.absorbed) + " were absorbed, " + std::to_string(m_report.truncated) +
                         " were cut off at max_bounces, none reached a diffuse receiver" +
                         (m_settings.store == Store::caustic ? " by way of a specular surface" : "") +
                         "; check where its " + count_lights(m_scene) + " shine, and where the receivers are");
    if (m_report.emitted >= MOST_EMITTED)
        throw SceneError(where + std::to_string(m_photon_count) + " photons were stored by 2^30 emitted, " +
                         std::to_string(m_settings.count) + " asked; ask for fewer, or move the light closer");
}

double Tracer::find_fraction() const {
    return m_settings.emitted ? static_cast<double>(m_report.emitted) / static_cast<double>(*m_settings.emitted)
                              : static_cast<double>(m_photon_count) / static_cast<double>(m_settings.count);
}

// A workgroup ran out of loop turns: from now on each lane shoots one path with all of them.
void Tracer::shoot_slowly() {
    if (m_push.paths_per_lane == 1)
        throw Error(m_scene.path.string() + ": a photon's rays meet more of the scene than one path can look through; "
                                            "split very long or overlapping triangles, or lower max_bounces");
    m_paths_per_lane = 1;
}

TracedPhotons Tracer::run(const Progress& progress) {
    require_memory();
    m_device.compile_ahead(
        {m_kernels.shoot, m_kernels.count, m_kernels.scan, m_kernels.write, m_kernels.sum, m_kernels.scale});
    double milliseconds = 0;
    std::string stage = "trace photons";
    while (!is_done()) {
        progress.report(stage, std::min(1.0, find_fraction()));
        choose_chunk(milliseconds);
        milliseconds = shoot();
        const std::uint32_t blocks = (m_push.count + shared::PATHS_PER_BLOCK - 1) / shared::PATHS_PER_BLOCK;
        const std::vector<glm::uvec2> offsets = m_scratch.block_offsets.read<glm::uvec2>(blocks + 1);
        const std::uint32_t kept = find_kept_paths(offsets);
        const glm::uvec2 added = offsets[(kept + shared::PATHS_PER_BLOCK - 1) / shared::PATHS_PER_BLOCK];
        write(kept, added);
        if (!account(kept)) {
            shoot_slowly();
            continue;
        }
        if (m_report.emitted == kept) // the first chunk says how many land
            stage += describe_share(static_cast<double>(added.x) / kept);
        m_photon_count += added.x;
        m_vertex_count += added.y;
        require_progress();
    }
    return finish(progress);
}

void Tracer::scale_power(const Progress& progress) {
    struct Push {
        std::uint32_t first;
        std::uint32_t count;
        float factor;
    };
    const float factor = static_cast<float>(1.0 / static_cast<double>(m_report.emitted));
    gpu::run_in_chunks(m_device, "scale power", m_photon_count, 1 << 16, progress,
                       [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
                           const Push push{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count),
                                           factor};
                           commands.dispatch(m_kernels.scale, {{"power_object", m_power.buffer()}}, push, count);
                       });
    for (auto* flux :
         {&m_report.flux_emitted, &m_report.flux_deposited, &m_report.flux_escaped, &m_report.flux_truncated})
        for (double& channel : *flux)
            channel /= static_cast<double>(m_report.emitted);
}

TracedPhotons Tracer::finish(const Progress& progress) {
    if (m_photon_count > 0)
        scale_power(progress);
    m_report.solid_angle = m_table.solid_angle;
    TracedPhotons traced;
    traced.report = m_report;
    traced.map.count = m_photon_count;
    traced.map.origin = m_scene.origin;
    const std::uint64_t bytes = m_photon_count * sizeof(glm::vec4);
    traced.map.position_emitter = m_position.finish(bytes);
    traced.map.normal_index = m_normal.finish(bytes);
    traced.map.power_object = m_power.finish(bytes);
    if (m_settings.paths) {
        gpu::Buffer starts = m_starts.finish((m_photon_count + 1) * sizeof(std::uint32_t));
        const std::uint32_t end = static_cast<std::uint32_t>(m_vertex_count);
        starts.upload(&end, sizeof end, m_photon_count * sizeof end);
        const std::uint64_t vertex_bytes = m_vertex_count * sizeof(glm::vec4);
        traced.map.paths = PathColumns{m_vertex_count, std::move(starts), m_vertices.finish(vertex_bytes),
                                       m_normals.finish(vertex_bytes)};
    }
    return traced;
}

} // namespace

TracedPhotons trace_photons(gpu::Device& device, const Scene& scene, const SceneBuffers& buffers,
                            const EmitterTable& emitters, const TraceSettings& settings, const Progress& progress) {
    require_settings("trace_photons", settings);
    return Tracer(device, scene, buffers, emitters, settings).run(progress);
}

} // namespace photonloupe
