// SPDX-License-Identifier: Apache-2.0
// Connects the stages and remembers what each was given.
#include "pipeline.h"

#include "core/settings.h"
#include "estimate/camera_frame.h"
#include "estimate/plot_photons.h"
#include "inspect/photon_colors.h"
#include "inspect/voronoi.h"
#include "photons/map_columns.h"
#include "photons/tree_kernels.h"

namespace photonloupe {
namespace {

std::string make_key(const Scene& scene, TraceSettings settings) {
    return scene.hash + "/" + write_key(list_settings(settings)) + (settings.paths ? "paths" : "");
}

void set_script_parameters(gpu::Device& device, Photons& photons, std::span<const float> values,
                           const std::vector<script::DeclaredParameter>& declared) {
    photons.forget_parameters();
    photons.map.parameters.reset();
    if (declared.empty())
        return;
    std::vector<ParameterAxis> axes;
    for (const script::DeclaredParameter& parameter : declared)
        axes.push_back({parameter.name, parameter.low, parameter.high,
                        parameter.is_periodic ? parameter.high - parameter.low : 0.0f});
    photons.map.parameters = make_parameters(device, values, std::move(axes));
}

// Compiles what a tree of so many photons needs.
void expect_tree(gpu::Device& device, std::uint64_t photon_count) {
    device.compile_ahead(TreeKernels(0, device.limits().subgroup_size).list(photon_count));
}

} // namespace

std::shared_ptr<const SceneBuffers> Workbench::find_buffers(const Scene& scene) {
    if (m_scene_hash != scene.hash) {
        m_scene_hash.clear(); // an upload that fails leaves nothing half-remembered
        m_scene_buffers.reset();
        m_scene_buffers = std::make_shared<SceneBuffers>(upload_scene(m_device, scene));
        m_scene_hash = scene.hash;
    }
    return m_scene_buffers;
}

std::shared_ptr<Photons> Workbench::trace_photons(const Scene& scene, const TraceSettings& settings,
                                                  const Progress& progress) {
    const std::string key = make_key(scene, settings);
    if (key == m_traced_key)
        if (std::shared_ptr<Photons> traced = m_traced.lock())
            return traced;
    // Most maps are looked at next; the kernels of the usual settings serve most others too. What is needed last is
    // named first.
    m_device.compile_ahead(list_render_kernels(scene, settings.store, {}));
    expect_tree(m_device, settings.count);
    m_device.compile_ahead({name_plot_kernel()});
    TracedPhotons traced = photonloupe::trace_photons(m_device, scene, *find_buffers(scene), settings, progress);
    auto photons = std::make_shared<Photons>();
    photons->map = std::move(traced.map);
    photons->report = traced.report;
    photons->store = settings.store;
    m_traced = photons;
    m_traced_key = key;
    return photons;
}

const KdTree& Workbench::find_tree(Photons& photons, const Progress& progress) {
    if (!photons.tree)
        photons.tree = build_tree(m_device, photons.map, progress);
    return *photons.tree;
}

Neighbors Workbench::find_neighbors(Photons& photons, std::span<const glm::vec4> points, std::uint32_t k,
                                    const Progress& progress) {
    require_k(k);
    return photonloupe::find_neighbors(m_device, {find_tree(photons, progress)}, ask_at(points), k, progress);
}

Neighbors Workbench::find_neighbors_of(Photons& photons, std::span<const std::uint32_t> ids, std::uint32_t k,
                                       const Progress& progress) {
    require_k(k);
    const NeighborQueries queries = ask_about(photons.map, ids);
    return photonloupe::find_neighbors(m_device, {find_tree(photons, progress)}, queries, k, progress);
}

Neighbors Workbench::find_parameter_neighbors(Photons& photons, std::span<const double> values, std::uint32_t k,
                                              const Progress& progress) {
    const ParameterTree& tree = find_parameter_tree(photons, progress);
    return photonloupe::find_neighbors(m_device, look_in(tree, Measure::parameters),
                                       ask_parameters_at(*tree.parameters, values), k, progress);
}

Neighbors Workbench::find_parameter_neighbors_of(Photons& photons, std::span<const std::uint32_t> ids, std::uint32_t k,
                                                 const Progress& progress) {
    const ParameterTree& tree = find_parameter_tree(photons, progress);
    return photonloupe::find_neighbors(m_device, look_in(tree, Measure::parameters),
                                       ask_with_rows(photons.map, *tree.parameters, ids), k, progress);
}

Neighbors Workbench::find_layer_neighbors_of(Photons& photons, std::span<const std::uint32_t> ids, std::uint32_t k,
                                             float beta, const Progress& progress) {
    const ParameterTree& tree = find_layered_tree(photons, progress);
    NeighborQueries queries = ask_with_rows(photons.map, *tree.parameters, ids);
    for (const float radius2 : find_radii2_of(photons, queries, k, progress))
        queries.reach2.push_back(scale_reach2(radius2, beta));
    return photonloupe::find_neighbors(m_device, look_in(tree, Measure::world), queries, k, progress);
}

Neighbors Workbench::find_layer_neighbors(Photons& photons, std::span<const glm::vec4> points, std::uint32_t center,
                                          std::uint32_t k, float beta, const Progress& progress) {
    const ParameterTree& tree = find_layered_tree(photons, progress);
    const std::uint32_t ids[] = {center};
    const NeighborQueries middle = ask_with_rows(photons.map, *tree.parameters, ids);
    NeighborQueries queries = ask_at(points);
    seek_in_layer(queries, middle.rows, scale_reach2(find_radii2_of(photons, middle, k, progress)[0], beta));
    return photonloupe::find_neighbors(m_device, look_in(tree, Measure::world), queries, k, progress);
}

Neighbors Workbench::find_range_neighbors(Photons& photons, std::span<const glm::vec4> points,
                                          std::span<const float> low, std::span<const float> high, std::uint32_t k,
                                          const Progress& progress) {
    NeighborQueries queries = ask_at(points);
    seek_in_intervals(queries, low, high);
    return photonloupe::find_neighbors(m_device, look_in(find_layered_tree(photons, progress), Measure::world), queries,
                                       k, progress);
}

std::vector<float> Workbench::find_radii2_of(Photons& photons, const NeighborQueries& queries, std::uint32_t k,
                                             const Progress& progress) {
    const OrderedQueries ordered = order_queries(m_device, queries);
    const gpu::Buffer radii =
        find_parameter_radii(m_device, find_parameter_tree(photons, progress), ordered.view(), k, progress);
    const std::vector<glm::vec4> found = radii.read<glm::vec4>(ordered.count);
    const std::vector<std::uint32_t> rows = ordered.result_rows.read<std::uint32_t>(ordered.count);
    std::vector<float> radii2(ordered.count);
    for (std::size_t i = 0; i < found.size(); ++i)
        radii2[rows[i]] = found[i].w >= static_cast<float>(k) ? found[i].x : std::numeric_limits<float>::infinity();
    return radii2;
}

std::vector<float> Workbench::measure_isotropy(Photons& photons, std::uint32_t k, const Progress& progress) {
    return photonloupe::measure_isotropy(m_device, find_parameter_tree(photons, progress), k, progress);
}

std::shared_ptr<const ParameterRows> Workbench::find_parameter_rows(Photons& photons) {
    if (!photons.parameter_rows)
        photons.parameter_rows = std::make_shared<ParameterRows>(make_parameter_rows(m_device, photons.map));
    return photons.parameter_rows;
}

const ParameterTree& Workbench::find_parameter_tree(Photons& photons, const Progress& progress) {
    if (!photons.parameter_tree)
        photons.parameter_tree = build_parameter_tree(m_device, photons.map, find_parameter_rows(photons), progress);
    return *photons.parameter_tree;
}

const ParameterTree& Workbench::find_layered_tree(Photons& photons, const Progress& progress,
                                                  std::optional<LayerReach> reach) {
    if (photons.layered_tree && (!reach || *reach == photons.layered_for))
        return *photons.layered_tree;
    const LayerReach suited = reach.value_or(LayerReach{});
    const float scale =
        choose_parameter_scale(m_device, find_parameter_tree(photons, progress), suited.k, suited.beta, progress);
    photons.layered_tree = build_layered_tree(m_device, photons.map, find_parameter_rows(photons), scale, progress);
    photons.layered_for = suited;
    photons.layered_scale = scale;
    return *photons.layered_tree;
}

gpu::Buffer Workbench::find_script_rows(Photons& photons, script::NeighborQuery::Space space,
                                        std::span<const std::uint32_t> ids, std::uint32_t k, float beta,
                                        const Progress& progress) {
    using Space = script::NeighborQuery::Space;
    return space == Space::world       ? find_neighbors_of(photons, ids, k, progress).ids
           : space == Space::parameter ? find_parameter_neighbors_of(photons, ids, k, progress).ids
                                       : find_layer_neighbors_of(photons, ids, k, beta, progress).ids;
}

void Workbench::take_script_columns(Photons& photons, const script::ScriptRun& run) {
    set_script_parameters(m_device, photons, run.values, script::list_declared(run));
    photons.map.colors.reset();
    if (run.colors)
        photons.map.colors = make_colors(m_device, script::choose_shown_colors(run));
}

script::ScriptRun Workbench::run_script(Photons& photons, const script::CompiledScript& script,
                                        const script::RunSettings& settings, const script::KeptColumns* kept,
                                        const Progress& progress) {
    std::optional<ParameterColumns> before = std::move(photons.map.parameters);
    photons.map.parameters.reset();
    try {
        const script::ScriptQueries queries{
            [&](script::NeighborQuery::Space space, std::span<const std::uint32_t> ids, std::uint32_t k, float beta) {
                return find_script_rows(photons, space, ids, k, beta, progress);
            },
            [&](std::span<const float> values, const std::vector<script::DeclaredParameter>& declared) {
                set_script_parameters(m_device, photons, values, declared);
            }};
        script::ScriptRun run = script::run_script(m_device, photons.map, script, settings, kept, queries, progress);
        take_script_columns(photons, run);
        return run;
    } catch (...) {
        photons.map.parameters = std::move(before);
        photons.forget_parameters();
        throw;
    }
}

std::shared_ptr<Photons> Workbench::take_relaxed(const Photons& source, RelaxedColumns columns) {
    auto photons = std::make_shared<Photons>();
    photons->map = std::move(columns.map);
    photons->report = source.report;
    photons->store = source.store;
    photons->state = std::make_shared<const RelaxedState>(std::move(columns.state));
    return photons;
}

Relaxation Workbench::start_relaxation(Photons& photons, const Scene* scene, const RelaxSettings& given,
                                       const Progress& progress) {
    const RelaxSettings settings = complete_settings(given, std::nullopt, photons.map.parameters.has_value());
    const KdTree& tree = find_tree(photons, progress);
    LayerTrees trees;
    if (settings.uses_layers()) {
        if (!settings.beta)
            throw Error("relax: beta is not known yet; measure the photons' isotropy, or give a number");
        const bool seeks_constraint = settings.constrains() && settings.constraint == Space::parameter;
        const LayerReach reach{seeks_constraint ? *settings.constraint_neighbors : settings.neighbors,
                               static_cast<float>(*settings.beta)};
        trees.by_parameters = &find_parameter_tree(photons, progress);
        trees.layered = &find_layered_tree(photons, progress, reach);
        trees.parameter_scale = photons.layered_scale;
    }
    RelaxSurface surface;
    if (scene && settings.surface == SurfaceChoice::automatic)
        surface = {find_buffers(*scene), scene->origin};
    return Relaxation(m_device, photons.map, tree, trees, settings, surface, progress);
}

gpu::Buffer Workbench::estimate_irradiance(Photons& photons, std::span<const glm::vec4> points,
                                           std::span<const glm::vec4> normals, const EstimateSettings& settings,
                                           const Progress& progress) {
    require_k(choose_k(settings));
    return estimate_irradiance_at(m_device, photons.map.power_object, find_tree(photons, progress), points, normals,
                                  settings, progress);
}

void Workbench::build_view_trees(Photons& photons, const Progress& progress) {
    find_tree(photons, progress);
    if (!photons.map.parameters)
        return;
    find_parameter_tree(photons, progress);
    find_layered_tree(photons, progress);
}

Image Workbench::render_voronoi(const Scene& scene, Photons& photons, const CameraChoice& looks,
                                const RenderSettings& settings, const Progress& progress) {
    const shared::CameraFrame camera = frame_camera(scene, find_camera(scene, looks), settings.width, settings.height);
    const inspect::SurfaceView view = inspect::see_surfaces(m_device, scene, *find_buffers(scene), camera,
                                                            {settings.width, settings.height}, progress);
    const inspect::CellImage cells =
        inspect::find_voronoi_cells(m_device, photons.map, find_tree(photons, progress), view, {}, progress);
    return inspect::paint_cells(cells, inspect::list_encoded_colors(photons.map));
}

Image Workbench::render(const Scene& scene, Photons* photons, const CameraChoice& camera,
                        const RenderSettings& settings, const Progress& progress) {
    if (!photons)
        return render_image(m_device, scene, *find_buffers(scene), nullptr, camera, settings, progress);
    if (settings.mode == RenderMode::voronoi)
        return render_voronoi(scene, *photons, camera, settings, progress);
    const bool needs_tree = settings.mode != RenderMode::photons;
    m_device.compile_ahead(list_render_kernels(scene, photons->store, settings));
    if (needs_tree && !photons->tree)
        expect_tree(m_device, photons->map.count);
    const KdTree none;
    const RenderedMap map{photons->map, needs_tree ? find_tree(*photons, progress) : none, photons->store};
    return render_image(m_device, scene, *find_buffers(scene), &map, camera, settings, progress);
}

} // namespace photonloupe
