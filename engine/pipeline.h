// SPDX-License-Identifier: Apache-2.0
// The program on one page: the stages in the order they run. Everything else delegates to a stage's folder.
//
//   load_scene → trace_photons → run_script → relax_photons → estimate_irradiance / render → save
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "estimate/render_image.h"
#include "photons/find_neighbors.h"
#include "photons/layer_scale.h"
#include "relax/isotropy.h"
#include "relax/relaxation.h"
#include "script/run/run_script.h"
#include "trace/trace_photons.h"

namespace photonloupe {

// How far layers reach: β times the distance to the k-th neighbour in parameter space.
struct LayerReach {
    std::uint32_t k = 50;
    float beta = 3.0f;
    bool operator==(const LayerReach&) const = default;
};

// A photon map with what later stages need of it, built when first asked for and then kept.
struct Photons {
    PhotonMap map;
    TraceReport report;
    Store store = Store::caustic;
    std::optional<KdTree> tree;
    std::shared_ptr<const ParameterRows> parameter_rows; // relaxations keep them
    std::optional<ParameterTree> parameter_tree;
    std::optional<ParameterTree> layered_tree;
    LayerReach layered_for;                    // what it was built to suit …
    float layered_scale = 0;                   // … and how it weighs parameters
    std::shared_ptr<const RelaxedState> state; // null: neither constrained nor relaxed

    // Trees of parameters that are no longer the map's.
    void forget_parameters() {
        parameter_rows.reset();
        parameter_tree.reset();
        layered_tree.reset();
    }
};

// Runs the stages on one device and remembers their inputs: a stage whose inputs did not change does not run again.
class Workbench {
public:
    explicit Workbench(gpu::Device& device) : m_device(device) {}

    // Traces, or hands out the living result of the same scene and settings.
    std::shared_ptr<Photons> trace_photons(const Scene& scene, const TraceSettings& settings, const Progress& progress);

    const KdTree& find_tree(Photons& photons, const Progress& progress = {});

    Neighbors find_neighbors(Photons& photons, std::span<const glm::vec4> points, std::uint32_t k,
                             const Progress& progress);
    Neighbors find_neighbors_of(Photons& photons, std::span<const std::uint32_t> ids, std::uint32_t k,
                                const Progress& progress);

    // In parameter space: around points of it (values, a row of all parameters each) or photons.
    Neighbors find_parameter_neighbors(Photons& photons, std::span<const double> values, std::uint32_t k,
                                       const Progress& progress);
    Neighbors find_parameter_neighbors_of(Photons& photons, std::span<const std::uint32_t> ids, std::uint32_t k,
                                          const Progress& progress);
    // In world space among the photons of a layer: each photon's own, one photon's, or what lies within ranges.
    Neighbors find_layer_neighbors_of(Photons& photons, std::span<const std::uint32_t> ids, std::uint32_t k, float beta,
                                      const Progress& progress);
    Neighbors find_layer_neighbors(Photons& photons, std::span<const glm::vec4> points, std::uint32_t center,
                                   std::uint32_t k, float beta, const Progress& progress);
    Neighbors find_range_neighbors(Photons& photons, std::span<const glm::vec4> points, std::span<const float> low,
                                   std::span<const float> high, std::uint32_t k, const Progress& progress);

    // Of parameters alone, and of positions and parameters: one built before, whatever it suits best, or where `reach`
    // is given one that suits it.
    const ParameterTree& find_parameter_tree(Photons& photons, const Progress& progress = {});
    const ParameterTree& find_layered_tree(Photons& photons, const Progress& progress = {},
                                           std::optional<LayerReach> reach = {});

    // Axis ratios of photons in world space around their k neighbours in parameter space, by id ([SJL15] eq. 5).
    std::vector<float> measure_isotropy(Photons& photons, std::uint32_t k, const Progress& progress);

    // Gives the photons the parameters and colors that a script computes; on an exception they keep what they have.
    script::ScriptRun run_script(Photons& photons, const script::CompiledScript& script,
                                 const script::RunSettings& settings, const script::KeptColumns* kept,
                                 const Progress& progress);

    // Measures the constraint and stands ready for the first step; `scene` may be null. What is automatic is chosen, as
    // of photons of unknown emission, but β is known where layers count. The photons must outlive it.
    Relaxation start_relaxation(Photons& photons, const Scene* scene, const RelaxSettings& settings,
                                const Progress& progress);

    // The photons where a relaxation put them, with what it measured; without parameters, colors and paths.
    static std::shared_ptr<Photons> take_relaxed(const Photons& source, RelaxedColumns columns);

    gpu::Buffer estimate_irradiance(Photons& photons, std::span<const glm::vec4> points,
                                    std::span<const glm::vec4> normals, const EstimateSettings& settings,
                                    const Progress& progress);

    // `photons` may be null for direct light alone.
    Image render(const Scene& scene, Photons* photons, const CameraChoice& camera, const RenderSettings& settings,
                 const Progress& progress);

    // The scene on the device, kept until another one is asked for.
    std::shared_ptr<const SceneBuffers> find_buffers(const Scene& scene);

    // All trees that queries of views ask for, so that several threads may then look at the photons.
    void build_view_trees(Photons& photons, const Progress& progress = {});

    gpu::Device& device() { return m_device; }

private:
    std::shared_ptr<const ParameterRows> find_parameter_rows(Photons& photons);
    // Squared r_q of queries with rows; inf where fewer than k have parameters.
    std::vector<float> find_radii2_of(Photons& photons, const NeighborQueries& queries, std::uint32_t k,
                                      const Progress& progress);
    gpu::Buffer find_script_rows(Photons& photons, script::NeighborQuery::Space space,
                                 std::span<const std::uint32_t> ids, std::uint32_t k, float beta,
                                 const Progress& progress);
    Image render_voronoi(const Scene& scene, Photons& photons, const CameraChoice& looks,
                         const RenderSettings& settings, const Progress& progress);
    void take_script_columns(Photons& photons, const script::ScriptRun& run);

    gpu::Device& m_device;
    std::string m_scene_hash;                            // of m_scene_buffers
    std::shared_ptr<const SceneBuffers> m_scene_buffers; // a relaxation keeps them as long as it lives
    std::string m_traced_key;                            // scene and settings of m_traced
    std::weak_ptr<Photons> m_traced;
};

} // namespace photonloupe
