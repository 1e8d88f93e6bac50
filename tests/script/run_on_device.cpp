// SPDX-License-Identifier: Apache-2.0
#include "script/run_on_device.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <stdexcept>

#include <glm/vec4.hpp>
#include <gtest/gtest.h>

#include "script/compile_script.h"
#include "script/run/pass_runner.h"
#include "support/shared_device.h"

namespace photonloupe::script::tests {
namespace {

constexpr float ORIGIN[] = {2.0f, -0.5f, 16.0f};

std::vector<glm::vec4> pack(const std::vector<float>& vectors, const std::function<float(std::size_t)>& last,
                            bool is_relative = false) {
    std::vector<glm::vec4> packed;
    for (std::size_t i = 0; 3 * i < vectors.size(); ++i) {
        glm::vec4 v(vectors[3 * i], vectors[3 * i + 1], vectors[3 * i + 2], last(i));
        for (int axis = 0; is_relative && axis < 3; ++axis)
            v[axis] -= ORIGIN[axis];
        packed.push_back(v);
    }
    return packed;
}

// World coordinates that survive being made relative and absolute again.
float round_in_world(float x, int axis) {
    return float(x - ORIGIN[axis]) + ORIGIN[axis];
}

PhotonMap upload(const HostPhotons& photons) {
    gpu::Device& device = test::get_device();
    PhotonMap map;
    map.count = photons.count;
    map.origin = {ORIGIN[0], ORIGIN[1], ORIGIN[2]};
    map.position_emitter = gpu::make_buffer(
        device,
        pack(
            photons.positions, [&](std::size_t i) { return std::bit_cast<float>(photons.emitters[i]); }, true),
        "positions");
    map.normal_index = gpu::make_buffer(device, pack(photons.normals, [](std::size_t) { return 0.0f; }), "normals");
    map.power_object = gpu::make_buffer(device, pack(photons.power, [](std::size_t) { return 0.0f; }), "power");
    PathColumns paths;
    paths.vertex_count = photons.path_vertices.size() / 3;
    paths.starts = gpu::make_buffer(
        device, std::vector<std::uint32_t>(photons.path_starts.begin(), photons.path_starts.end()), "starts");
    const auto tag = [&](std::size_t i) {
        return std::bit_cast<float>(std::uint32_t{photons.path_interactions[i]} << 24 |
                                    (std::uint32_t(photons.path_objects[i]) & 0xffffffu));
    };
    paths.vertices = gpu::make_buffer(device, pack(photons.path_vertices, tag, true), "vertices");
    paths.normals = gpu::make_buffer(
        device, pack(photons.path_normals, [&](std::size_t i) { return photons.path_scatter[i]; }), "path normals");
    map.paths = std::move(paths);
    return map;
}

bool are_near(float a, float b, const Comparison& comparison) {
    if ((std::isnan(a) && std::isnan(b)) || a == b)
        return true;
    const float size = std::max(std::abs(a), std::abs(b));
    const double ulp = std::nextafter(size, std::numeric_limits<float>::infinity()) - size;
    return std::abs(double(a) - double(b)) <= std::max(comparison.ulps * ulp, comparison.absolute);
}

// Variables that hold something after the run and are not local to a loop.
void expect_same_variables(Ran& device, Ran& host, const Plan& plan, const Comparison& comparison) {
    for (std::size_t v = 0; v < host.program.variables.size(); ++v) {
        const Variable& variable = host.program.variables[v];
        bool is_compared = !variable.is_local && variable.type != Type::list && host.state.variables[v].is_set;
        for (const PhotonLoop& loop : plan.loops)
            if (const auto found = loop.variables.find(std::uint32_t(v)); found != loop.variables.end())
                is_compared &= found->second.role != Role::local;
        if (!is_compared)
            continue;
        for (std::size_t i = 0; i < host.state.variables[v].numbers.size(); ++i) {
            const Number a = device.state.variables[v].numbers[i], b = host.state.variables[v].numbers[i];
            if (variable.type == Type::integer)
                EXPECT_EQ(a.integer, b.integer) << variable.name << '[' << i << ']';
            else
                EXPECT_TRUE(are_near(a.real, b.real, comparison))
                    << variable.name << '[' << i << "] is " << a.real << ", not " << b.real;
        }
    }
}

void expect_same_columns(Ran& device, Ran& host, const Comparison& comparison) {
    ASSERT_EQ(device.outputs.columns.declared().size(), host.outputs.columns.declared().size());
    const auto& a = device.outputs.columns.host_parameters();
    const auto& b = host.outputs.columns.host_parameters();
    int shown = 0;
    for (std::size_t d = 0; d < b.size(); ++d)
        for (std::size_t i = 0; i < b[d].size(); ++i)
            if (!are_near(a[d][i], b[d][i], comparison) && shown++ < 5)
                ADD_FAILURE() << "photon " << i << " parameter " << d + 3 << " is " << a[d][i] << ", not " << b[d][i];
    const std::vector<float>&c = device.outputs.columns.host_colors(), &e = host.outputs.columns.host_colors();
    for (std::size_t i = 0; i < e.size(); ++i)
        if (!are_near(c[i], e[i], comparison) && shown++ < 5)
            ADD_FAILURE() << "photon " << i / 3 << " color is " << c[i] << ", not " << e[i];
}

std::string describe(const Program& program, const FaultReport& fault) {
    return program.source.text.substr(fault.site.span.begin, fault.site.span.end - fault.site.span.begin) + ": " +
           describe_fault(fault.site.kind) + " ×" + std::to_string(fault.count) + " first " +
           std::to_string(fault.first_photon);
}

void expect_same_reports(const Ran& device, const Ran& host) {
    std::set<std::string> found, expected;
    for (const FaultReport& fault : device.outputs.faults)
        found.insert(describe(device.program, fault));
    for (const FaultReport& fault : host.outputs.faults)
        expected.insert(describe(host.program, fault));
    EXPECT_EQ(found, expected);
    EXPECT_EQ(device.outputs.prints, host.outputs.prints);
    std::vector<HistogramCounts> met = device.outputs.histograms;
    std::erase_if(met, [](const HistogramCounts& h) { // a pass has those that no photon met, too
        return h.below + h.above + h.non_finite == 0 &&
               std::all_of(h.counts.begin(), h.counts.end(), [](std::uint32_t count) { return count == 0; });
    });
    ASSERT_EQ(met.size(), host.outputs.histograms.size());
    for (std::size_t i = 0; i < host.outputs.histograms.size(); ++i) {
        const HistogramCounts &a = met[i], &b = host.outputs.histograms[i];
        EXPECT_EQ(a.counts, b.counts);
        EXPECT_EQ(a.below, b.below);
        EXPECT_EQ(a.above, b.above);
        EXPECT_EQ(a.non_finite, b.non_finite);
    }
    ASSERT_EQ(device.outputs.loops.size(), host.outputs.loops.size());
    for (std::size_t i = 0; i < host.outputs.loops.size(); ++i) {
        EXPECT_EQ(device.outputs.loops[i].exhausted, host.outputs.loops[i].exhausted);
        EXPECT_EQ(device.outputs.loops[i].first_exhausted, host.outputs.loops[i].first_exhausted);
    }
}

} // namespace

HostPhotons make_random_photons(std::uint32_t count, std::uint32_t seed, std::uint32_t given) {
    std::mt19937 random(seed);
    const auto draw = [&random](float low, float high) {
        return low + (high - low) * float(random() >> 8) / 16777216.0f;
    };
    HostPhotons photons = make_photons(count, 2);
    photons.positions.clear();
    photons.normals.clear();
    photons.power.clear();
    photons.emitters.clear();
    photons.path_starts = {0};
    photons.path_vertices.clear();
    photons.path_normals.clear();
    photons.path_scatter.clear();
    photons.path_interactions.clear();
    photons.path_objects.clear();
    const auto add_unit = [&](std::vector<float>& list) {
        const float z = draw(-1, 1), angle = draw(0, 6.28f), r = std::sqrt(1 - z * z);
        list.insert(list.end(), {r * std::cos(angle), r * std::sin(angle), z});
    };
    const auto add_point = [&](std::vector<float>& list) {
        for (int axis = 0; axis < 3; ++axis)
            list.push_back(round_in_world(draw(-3, 3), axis));
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        add_point(photons.positions);
        add_unit(photons.normals);
        photons.power.insert(photons.power.end(), {draw(0, 1), draw(0, 2), draw(0, 3)});
        photons.emitters.push_back(std::int32_t(random() % 3));
        const std::uint32_t vertices = given > 0 ? given : 2 + random() % 6;
        for (std::uint32_t j = 0; j < vertices; ++j) {
            add_point(photons.path_vertices);
            add_unit(photons.path_normals);
            photons.path_scatter.push_back(draw(0, 1));
            photons.path_interactions.push_back(j == 0 || j + 1 == vertices ? 0 : std::uint8_t(1 + random() % 2));
            photons.path_objects.push_back(std::int32_t(random() % 5) - 1);
        }
        photons.path_starts.push_back(photons.path_starts.back() + vertices);
    }
    return photons;
}

Ran run_on_device(const std::string& text, HostPhotons photons, const RunSettings& settings) {
    Ran ran;
    const std::unique_ptr<CompiledScript> script = compile_script({"test.photon", text});
    if (script->has_errors) {
        ran.errors = format_diagnostics(script->program.source, script->diagnostics);
        return ran;
    }
    const PhotonMap map = upload(photons);
    ran.outputs.columns = ScriptColumns(photons.count);
    const Progress quiet;
    const FindRows find_rows = [&](NeighborQuery::Space space, std::span<const std::uint32_t> ids, std::uint32_t k,
                                   float beta) {
        std::vector<std::int32_t> rows;
        for (const std::uint32_t id : ids) {
            std::vector<std::int32_t> row = photons.find_neighbors(space, id, k, beta);
            row.resize(k, -1);
            rows.insert(rows.end(), row.begin(), row.end());
        }
        return gpu::make_buffer(test::get_device(), rows, "rows");
    };
    PassRunner passes(test::get_device(), map, script->program, script->plan, script->passes, ran.outputs, settings,
                      find_rows, quiet);
    Interpreter interpreter(script->program, script->plan, photons, ran.outputs, settings, quiet);
    interpreter.run(
        [&](const PhotonLoop& loop, Interpreter& host, LoopReport& report) { return passes.run(loop, host, report); });
    ran.outputs.columns.host_parameters(); // while their device lives
    ran.outputs.columns.host_colors();
    ran.outputs.columns.set_download({});
    ran.state = interpreter.state();
    ran.program = script->program;
    return ran;
}

void expect_same(const std::string& text, const HostPhotons& photons, const Comparison& comparison,
                 const RunSettings& settings) {
    Ran host = interpret(text, photons, settings);
    ASSERT_EQ(host.errors, "") << text;
    Diagnostics diagnostics;
    const Plan plan = plan_photon_loops(host.program, diagnostics);
    for (const PhotonLoop& loop : plan.loops)
        EXPECT_EQ(loop.is_parallel, comparison.is_parallel.value_or(loop.is_parallel))
            << format_diagnostics(host.program.source, loop.reasons);
    Ran device = run_on_device(text, photons, settings);
    for (const LoopReport& loop : device.outputs.loops)
        EXPECT_EQ(loop.is_parallel, comparison.is_parallel.value_or(loop.is_parallel)) << text;
    expect_same_variables(device, host, plan, comparison);
    expect_same_columns(device, host, comparison);
    expect_same_reports(device, host);
    if (::testing::Test::HasFailure())
        ADD_FAILURE() << text;
}

} // namespace photonloupe::script::tests
