// SPDX-License-Identifier: Apache-2.0
// A run from the first statement to the columns it leaves.
#include "script/run/run_script.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "photons/map_columns.h"
#include "script/builtins.h"

namespace photonloupe::script {
namespace {

constexpr std::pair<std::uint32_t, const char*> COLUMN_NAMES[] = {
    {COLUMN_POSITION, "positions"},
    {COLUMN_NORMAL, "normals"},
    {COLUMN_POWER, "power"},
    {COLUMN_EMITTER, "emitter"},
    {COLUMN_PARAMETERS, "parameters"},
    {COLUMN_PATH_STARTS, "path_offsets"},
    {COLUMN_PATH_VERTICES, "path_vertices"},
    {COLUMN_PATH_NORMALS, "path_normals"},
    {COLUMN_PATH_INTERACTIONS, "path_interactions"},
    {COLUMN_PATH_OBJECTS, "path_objects"},
    {COLUMN_PATH_SCATTER, "path_scatter"},
};

// The columns of paths that a map has.
std::uint32_t find_path_columns(const PhotonMap& photons) {
    if (!photons.paths)
        return 0;
    const PathColumns& paths = *photons.paths;
    std::uint32_t columns = COLUMN_PATH_STARTS | COLUMN_PATH_VERTICES;
    for (const auto& [has, column] : {std::pair(paths.has_normals, COLUMN_PATH_NORMALS),
                                      {paths.has_interactions, COLUMN_PATH_INTERACTIONS},
                                      {paths.has_objects, COLUMN_PATH_OBJECTS},
                                      {paths.has_scatter, COLUMN_PATH_SCATTER}})
        columns |= has ? column : 0u;
    return columns;
}

// Rows of neighbours the interpreter asks for at once.
constexpr std::uint32_t ROWS_AT_ONCE = 1024;

void fetch_columns(const PhotonMap& photons, HostPhotons& host, std::uint32_t columns) {
    if (columns & COLUMN_POSITION)
        host.positions = read_positions(photons);
    if (columns & COLUMN_NORMAL)
        host.normals = read_vectors(photons.normal_index, photons.count);
    if (columns & COLUMN_POWER)
        host.power = read_vectors(photons.power_object, photons.count);
    if (columns & COLUMN_EMITTER)
        host.emitters = read_emitters(photons);
    if (!photons.paths) { // no path has a vertex
        host.path_starts.assign(photons.count + 1, 0);
        return;
    }
    const PathColumns& paths = *photons.paths;
    if (columns & COLUMN_PATH_STARTS)
        host.path_starts = read_path_offsets(paths, photons.count);
    if (columns & COLUMN_PATH_VERTICES)
        host.path_vertices = read_path_vertices(paths, photons.origin);
    if (columns & COLUMN_PATH_NORMALS)
        host.path_normals = read_vectors(paths.normals, paths.vertex_count);
    if (columns & COLUMN_PATH_INTERACTIONS)
        host.path_interactions = read_path_interactions(paths);
    if (columns & COLUMN_PATH_OBJECTS)
        host.path_objects = read_path_objects(paths);
    if (columns & COLUMN_PATH_SCATTER)
        host.path_scatter = read_path_scatter(paths);
}

// Rows for a run of photons, so that a serial loop does not ask for each alone.
struct RowCache {
    NeighborQuery::Space space{};
    std::uint32_t k = 0, first = 0, count = 0;
    float beta = 0;
    std::uint64_t version = 0; // of the script's columns
    std::vector<std::int32_t> ids;
};

class Run {
public:
    Run(gpu::Device& device, const PhotonMap& photons, const CompiledScript& script, const RunSettings& settings,
        const ScriptQueries& queries, const Progress& progress)
        : m_photons(photons), m_script(script), m_queries(queries) {
        m_host.count = static_cast<std::uint32_t>(photons.count);
        m_host.fetch = [&photons](HostPhotons& host, std::uint32_t columns) { fetch_columns(photons, host, columns); };
        m_host.find_neighbors = [this](NeighborQuery::Space space, std::uint32_t photon, std::uint32_t k, float beta) {
            return find_row(space, photon, k, beta);
        };
        m_outputs.columns = ScriptColumns(photons.count);
        m_passes.emplace(
            device, photons, script.program, script.plan, script.passes, m_outputs, settings,
            [this](NeighborQuery::Space space, std::span<const std::uint32_t> ids, std::uint32_t k, float beta) {
                return find_rows(space, ids, k, beta);
            },
            progress);
        m_interpreter.emplace(script.program, script.plan, m_host, m_outputs, settings, progress);
    }

    ScriptRun finish(bool keeps) {
        if (keeps)
            take_kept();
        m_interpreter->run([this](const PhotonLoop& loop, Interpreter& interpreter, LoopReport& report) {
            return m_passes->run(loop, interpreter, report);
        });
        return collect();
    }

private:
    // The parameters and colors that the map has.
    void take_kept() {
        ScriptColumns& columns = m_outputs.columns;
        if (const auto& kept = m_photons.parameters)
            for (std::uint32_t i = 0; i < kept->count; ++i) {
                const ParameterAxis& axis = kept->axes[i];
                columns.declare(FIRST_DIMENSION + i, {axis.name, static_cast<float>(axis.low),
                                                      static_cast<float>(axis.high), axis.period > 0});
            }
        if (const auto& kept = m_photons.parameters)
            for (std::uint32_t i = 0; i < kept->count; ++i)
                for (std::size_t photon = 0; photon < m_photons.count; ++photon)
                    if (const float value = (*kept->given)[photon * kept->count + i]; !std::isnan(value))
                        columns.write_parameter(i, photon, value);
        if (!m_photons.given_colors)
            return;
        const std::vector<float>& colors = *m_photons.given_colors;
        for (std::size_t i = 0; i < colors.size(); i += 3)
            if (!std::isnan(colors[i]))
                columns.write_color(i / 3, {colors[i], colors[i + 1], colors[i + 2]});
    }

    std::vector<float> gather_values() {
        const std::vector<std::vector<float>>& parameters = m_outputs.columns.host_parameters();
        std::vector<float> values(m_photons.count * parameters.size());
        for (std::size_t i = 0; i < parameters.size(); ++i)
            for (std::size_t photon = 0; photon < m_photons.count; ++photon) {
                const float value = parameters[i][photon];
                values[photon * parameters.size() + i] =
                    std::isfinite(value) ? value : std::numeric_limits<float>::quiet_NaN();
            }
        return values;
    }

    gpu::Buffer find_rows(NeighborQuery::Space space, std::span<const std::uint32_t> ids, std::uint32_t k, float beta) {
        const std::uint64_t version = m_outputs.columns.version();
        if (space != NeighborQuery::Space::world && std::exchange(m_published, version) != version)
            m_queries.set_parameters(gather_values(), m_outputs.columns.declared());
        return m_queries.find_rows(space, ids, k, beta);
    }

    std::vector<std::int32_t> find_row(NeighborQuery::Space space, std::uint32_t photon, std::uint32_t k, float beta) {
        const std::uint64_t version = m_outputs.columns.version();
        const bool is_same = m_cache.k == k && m_cache.space == space && m_cache.beta == beta &&
                             (space == NeighborQuery::Space::world || m_cache.version == version);
        if (!is_same || photon < m_cache.first || photon - m_cache.first >= m_cache.count) {
            const std::uint32_t count = std::min(ROWS_AT_ONCE, m_host.count - photon);
            std::vector<std::uint32_t> ids(count);
            std::iota(ids.begin(), ids.end(), photon);
            m_cache = {space, k, photon, count, beta, version, {}};
            m_cache.ids = find_rows(space, ids, k, beta).read<std::int32_t>(std::uint64_t{count} * k);
        }
        const auto row = m_cache.ids.begin() + static_cast<std::ptrdiff_t>(std::size_t{photon - m_cache.first} * k);
        return {row, std::find(row, row + k, -1)};
    }

    ScriptRun collect();
    std::vector<ParameterResult> count_values(const std::vector<std::vector<float>>& columns) const;
    std::uint32_t find_line(std::size_t index) const;

    const PhotonMap& m_photons;
    const CompiledScript& m_script;
    const ScriptQueries& m_queries;
    HostPhotons m_host;
    RunOutputs m_outputs;
    std::optional<PassRunner> m_passes;
    std::optional<Interpreter> m_interpreter;
    RowCache m_cache;
    std::uint64_t m_published = ~0ull; // version of the columns that queries know
};

void count(ValueCount& counted, std::size_t photon) {
    if (counted.count++ == 0)
        counted.first_photon = static_cast<std::uint32_t>(photon);
}

// The first statement that sets the dimension, where it names it by a number known beforehand.
std::uint32_t Run::find_line(std::size_t index) const {
    const Program& program = m_script.program;
    std::uint32_t line = 0;
    const auto look = [&](const Expression& expression) {
        if (line || expression.kind != Expression::Kind::builtin ||
            expression.builtin->id != BuiltinId::set_photon_parameter)
            return;
        const Expression& dimension = expression.operands[1];
        std::optional<double> value;
        if (dimension.kind == Expression::Kind::number)
            value = dimension.type == Type::integer ? dimension.integer : dimension.real;
        else if (dimension.kind == Expression::Kind::variable)
            value = program.variables[dimension.variable].constant;
        if (value && *value == static_cast<double>(FIRST_DIMENSION + index))
            line = program.source.find_place(expression.span.begin).line;
    };
    visit_expressions(program.body, look);
    for (const Function& function : program.functions)
        visit_expressions(function.body, look);
    return line;
}

std::vector<ParameterResult> Run::count_values(const std::vector<std::vector<float>>& columns) const {
    std::vector<ParameterResult> results;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        ParameterResult& result = results.emplace_back(ParameterResult{m_outputs.columns.declared()[i]});
        result.line = find_line(i);
        for (std::size_t photon = 0; photon < columns[i].size(); ++photon) {
            const float value = columns[i][photon];
            if (!std::isfinite(value)) {
                count(result.unset, photon);
                if (!is_unset(value))
                    count(result.non_finite, photon);
            } else if (value < result.declared.low || value > result.declared.high) {
                count(result.out_of_bounds, photon);
            }
        }
    }
    return results;
}

ScriptRun Run::collect() {
    ScriptRun run;
    ScriptColumns& columns = m_outputs.columns;
    if (!columns.declared().empty()) {
        run.values = gather_values();
        run.parameters = count_values(columns.host_parameters());
    }
    if (columns.has_colors()) {
        run.colors = columns.host_colors();
        for (std::size_t i = 0; i < run.colors->size(); i += 3) {
            float* color = &(*run.colors)[i];
            if (!std::isfinite(color[0]) || !std::isfinite(color[1]) || !std::isfinite(color[2]))
                std::fill_n(color, 3, std::numeric_limits<float>::quiet_NaN());
        }
    }
    for (const std::uint32_t index : m_script.program.exposed) {
        const Variable& variable = m_script.program.variables[index];
        const Number value = m_interpreter->exposed_value(index);
        run.exposed[variable.name] =
            variable.type == Type::integer ? static_cast<double>(value.integer) : static_cast<double>(value.real);
    }
    run.histograms = std::move(m_outputs.histograms);
    run.prints = std::move(m_outputs.prints);
    run.faults = std::move(m_outputs.faults);
    run.loops = std::move(m_outputs.loops);
    run.stopped = std::move(m_outputs.stopped);
    return run;
}

} // namespace

std::vector<std::string> list_columns(const Program& program) {
    std::vector<std::string> names;
    for (const auto& [bit, name] : COLUMN_NAMES)
        if (program.columns & bit)
            names.emplace_back(name);
    return names;
}

void require_columns(const Program& program, const PhotonMap& photons) {
    const std::uint32_t there = find_path_columns(photons);
    for (const auto& [bit, name] : COLUMN_NAMES)
        if (bit >= COLUMN_PATH_STARTS && program.columns & bit & ~there)
            throw ArgumentError("the script reads " + std::string(name) +
                                ", which this map does not have; give it to from_arrays");
}

std::vector<DeclaredParameter> list_declared(const ScriptRun& run) {
    std::vector<DeclaredParameter> declared;
    for (const ParameterResult& parameter : run.parameters)
        declared.push_back(parameter.declared);
    return declared;
}

ScriptRun run_script(gpu::Device& device, const PhotonMap& photons, const CompiledScript& script,
                     const RunSettings& settings, bool keeps, const ScriptQueries& queries, const Progress& progress) {
    require_script(script);
    return Run(device, photons, script, settings, queries, progress).finish(keeps);
}

} // namespace photonloupe::script
