// SPDX-License-Identifier: Apache-2.0
// Photon tracing is a function of its settings alone: not of memory, chunks, or what else is recorded.
#include "trace/trace_photons.h"

#include <cmath>

#include <gtest/gtest.h>

#include "scene/gltf_builder.h"
#include "scene/probe_rays.h"
#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

Scene load_example(const std::string& name) {
    return load_scene(std::string(PHOTONLOUPE_SOURCE_DIR "/scenes/") + name + "/" + name + ".gltf");
}

// The columns as plain words, compared bit for bit.
struct Columns {
    std::vector<glm::uvec4> position, normal, power;
    std::vector<std::uint32_t> starts;
    std::vector<glm::uvec4> vertices, normals;
    TraceReport report;

    bool operator==(const Columns& other) const {
        return position == other.position && normal == other.normal && power == other.power && starts == other.starts &&
               vertices == other.vertices && normals == other.normals &&
               report.flux_deposited == other.report.flux_deposited;
    }
};

Columns trace(const Scene& scene, const TraceSettings& settings, gpu::Device& device = get_device()) {
    const SceneBuffers buffers = upload_scene(device, scene);
    const TracedPhotons traced = trace_photons(device, scene, buffers, build_emitters(scene, settings.store), settings);
    const PhotonMap& map = traced.map;
    Columns columns{map.position_emitter.read<glm::uvec4>(map.count),
                    map.normal_index.read<glm::uvec4>(map.count),
                    map.power_object.read<glm::uvec4>(map.count),
                    {},
                    {},
                    {},
                    traced.report};
    if (map.paths) {
        columns.starts = map.paths->starts.read<std::uint32_t>(map.count + 1);
        columns.vertices = map.paths->vertices.read<glm::uvec4>(map.paths->vertex_count);
        columns.normals = map.paths->normals.read<glm::uvec4>(map.paths->vertex_count);
    }
    return columns;
}

struct TraceCase {
    const char* scene;
    Store store;
    Emission emission;
};

class Trace : public ::testing::TestWithParam<TraceCase> {
protected:
    const Scene m_scene = load_example(GetParam().scene);
    TraceSettings m_settings{
        .count = 3000, .seed = 7, .emission = GetParam().emission, .store = GetParam().store, .max_bounces = 8};
};

INSTANTIATE_TEST_SUITE_P(, Trace,
                         ::testing::Values(TraceCase{"ring", Store::caustic, Emission::sobol},
                                           TraceCase{"slab", Store::caustic, Emission::random},
                                           TraceCase{"slab", Store::all, Emission::sobol}),
                         [](const auto& info) {
                             return std::string(info.param.scene) + (info.param.store == Store::all ? "_all" : "") +
                                    (info.param.emission == Emission::random ? "_random" : "");
                         });

TEST_P(Trace, gives_the_same_bits_again) {
    m_settings.paths = true;
    EXPECT_TRUE(trace(m_scene, m_settings) == trace(m_scene, m_settings));
}

TEST_P(Trace, gives_other_photons_for_another_seed) {
    const Columns first = trace(m_scene, m_settings);
    ++m_settings.seed;
    EXPECT_FALSE(first == trace(m_scene, m_settings));
}

TEST_P(Trace, stores_the_same_photons_with_paths_and_without) {
    Columns without = trace(m_scene, m_settings);
    m_settings.paths = true;
    Columns with = trace(m_scene, m_settings);
    EXPECT_EQ(with.starts.size(), with.position.size() + 1);
    with.starts.clear(), with.vertices.clear(), with.normals.clear();
    EXPECT_TRUE(with == without);
}

TEST_P(Trace, ends_each_path_at_its_photon) {
    m_settings.paths = true;
    const Columns columns = trace(m_scene, m_settings);
    for (std::size_t i = 0; i < columns.position.size(); ++i) {
        const glm::uvec4 end = columns.vertices.at(columns.starts[i + 1] - 1);
        EXPECT_EQ(glm::uvec3(end), glm::uvec3(columns.position[i])) << "photon " << i;
        EXPECT_EQ(end.w >> 24, shared::INTERACTION_END) << "photon " << i;
    }
}

TEST_P(Trace, begins_with_the_same_photons_when_more_are_asked_for) {
    const Columns fewer = trace(m_scene, m_settings);
    m_settings.count = 60'000;
    const Columns more = trace(m_scene, m_settings);
    ASSERT_GT(more.position.size(), fewer.position.size());
    const auto is_prefix = [](const std::vector<glm::uvec4>& a, const std::vector<glm::uvec4>& b) {
        return std::equal(a.begin(), a.end(), b.begin());
    };
    EXPECT_TRUE(is_prefix(fewer.position, more.position));
    EXPECT_TRUE(is_prefix(fewer.normal, more.normal));
}

TEST_P(Trace, emits_what_it_is_told_and_stores_the_same_as_by_count) {
    const Columns by_count = trace(m_scene, m_settings);
    m_settings.emitted = by_count.report.emitted;
    EXPECT_TRUE(trace(m_scene, m_settings) == by_count);
}

TEST_P(Trace, emits_any_number_and_keeps_the_beginning) {
    m_settings.emitted = 10'001;
    const Columns whole = trace(m_scene, m_settings);
    m_settings.emitted = 5003;
    const Columns part = trace(m_scene, m_settings);
    EXPECT_EQ(part.report.emitted, 5003u);
    ASSERT_LT(part.position.size(), whole.position.size());
    EXPECT_TRUE(std::equal(part.position.begin(), part.position.end(), whole.position.begin()));
}

// The chunk shrinks with the range of a descriptor, and every buffer goes by address.
TEST_P(Trace, gives_the_same_bits_in_smaller_chunks_by_address) {
    m_settings.paths = true;
    m_settings.emitted = 3 * shared::EMISSION_BLOCK;
    const ScopedVariable range("PHOTONLOUPE_STORAGE_RANGE", "64");
    gpu::Device device;
    EXPECT_TRUE(trace(m_scene, m_settings, device) == trace(m_scene, m_settings));
}

TEST_P(Trace, gives_the_same_bits_by_way_of_staging) {
    const ScopedVariable forced("PHOTONLOUPE_FORCE_STAGING", "1");
    gpu::Device device;
    EXPECT_TRUE(trace(m_scene, m_settings, device) == trace(m_scene, m_settings));
}

TEST_P(Trace, accounts_for_every_path_and_for_the_flux) {
    m_settings.emitted = 50'000;
    const TraceReport report = trace(m_scene, m_settings).report;
    EXPECT_EQ(report.emitted, report.absorbed + report.escaped + report.truncated + report.ended_on_receiver);
    for (std::size_t channel = 0; channel < 3; ++channel)
        EXPECT_NEAR((report.flux_deposited[channel] + report.flux_escaped[channel] + report.flux_truncated[channel]) /
                        report.flux_emitted[channel],
                    1.0, 1e-5);
}

// A white ball of 20,480 triangles around a light: nothing is lost, so every path is cut off at the limit.
TEST(TraceLong, paths_of_64_bounces_among_many_triangles_all_reach_the_limit) {
    Vectors corners;
    for (const Corners& triangle : make_ball(5, 0.02f, 1))
        for (const glm::vec3& corner : triangle)
            corners.push_back({corner.x, corner.y, corner.z});
    GltfBuilder builder;
    builder.add_material({{"pbrMetallicRoughness", {{"metallicFactor", 0.0}}}, {"doubleSided", true}});
    const std::size_t positions = builder.add_vectors(corners);
    builder.add_object({{"attributes", {{"POSITION", positions}}}, {"material", 0}});
    builder.document["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 1.0}}};
    builder.document["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const Scene scene = load(builder);
    const TraceReport report = trace(scene, {.emitted = 4096, .store = Store::all, .max_bounces = 64}).report;
    EXPECT_EQ(report.escaped, 0u);
    EXPECT_EQ(report.truncated, 4096u);
    EXPECT_NEAR(report.flux_truncated[0], report.flux_emitted[0], 1e-5 * report.flux_emitted[0]);
}

} // namespace
} // namespace photonloupe::test
