// SPDX-License-Identifier: Apache-2.0
// Connects the stages and remembers what each gave.
#include "pipeline.h"

#include <utility>

#include "estimate/camera_frame.h"
#include "estimate/media_photons.h"
#include "estimate/plot_photons.h"
#include "inspect/photon_colors.h"
#include "inspect/voronoi.h"
#include "photons/map_columns.h"
#include "photons/nearest_query.h"
#include "photons/select_photons.h"
#include "photons/tree_kernels.h"
#include "stage_keys.h"
#include "trace/find_traced.h"

namespace photonloupe {
namespace {

constexpr std::uint64_t MOST_REMEMBERED_PIXELS = 1ull << 22; // of a picture that is kept: 48 MiB

std::vector<ParameterAxis> list_axes(const std::vector<script::DeclaredParameter>& declared) {
    std::vector<ParameterAxis> axes;
    for (const script::DeclaredParameter& parameter : declared)
        axes.push_back({parameter.name, parameter.low, parameter.high,
                        parameter.is_periodic ? parameter.high - parameter.low : 0.0f});
    return axes;
}

SearchSpace choose_space(script::NeighborQuery::Space space) {
    using Space = script::NeighborQuery::Space;
    return space == Space::world       ? SearchSpace::world
           : space == Space::parameter ? SearchSpace::parameter
                                       : SearchSpace::constrained;
}

void take_script_columns(Photons& photons, const Photons& scripted) {
    const std::lock_guard lock(*photons.mutex);
    PhotonMap columns = share_map(scripted.map);
    photons.map.parameters = std::move(columns.parameters);
    photons.map.colors = std::move(columns.colors);
    photons.map.given_colors = std::move(columns.given_colors);
    photons.trees = scripted.trees;
}

// Compiles what a tree of so many photons needs.
void expect_tree(gpu::Device& device, std::uint64_t photon_count) {
    device.compile_ahead(TreeKernels(0, device.limits().subgroup_size).list(photon_count));
}

} // namespace

std::shared_ptr<const SceneBuffers> Workbench::find_buffers(const Scene& scene) {
    const MemoKey key(scene.hash);
    if (std::shared_ptr<const SceneBuffers> buffers = m_scene_buffers.recall(key))
        return buffers;
    m_scene_buffers.forget(); // not two scenes at once
    return m_scene_buffers.find(key, [&] { return upload_scene(m_device, scene); });
}

std::shared_ptr<const EmitterTable> Workbench::find_emitters(const Scene& scene, Store store) {
    return m_emitters.find(MemoKey(scene.hash, static_cast<int>(store)), [&] { return build_emitters(scene, store); });
}

std::shared_ptr<Photons> Workbench::trace_photons(const Scene& scene, const TraceSettings& settings,
                                                  const Progress& progress) {
    const std::shared_ptr<const Photons> traced =
        m_traced.find(make_key(scene, settings), [&] { return trace_anew(scene, settings, progress); });
    std::shared_ptr<Photons> photons = share_photons(*traced);
    photons->made_by = traced;
    return photons;
}

Photons Workbench::trace_anew(const Scene& scene, const TraceSettings& settings, const Progress& progress) {
    // Most maps are looked at next; the kernels of the usual settings serve most others too. What is needed last is
    // named first.
    m_device.compile_ahead(list_render_kernels(scene, settings.store, {}));
    expect_tree(m_device, settings.count);
    m_device.compile_ahead({name_plot_kernel(scene)});
    TracedPhotons traced = photonloupe::trace_photons(m_device, scene, *find_buffers(scene),
                                                      *find_emitters(scene, settings.store), settings, progress);
    Photons photons;
    photons.map = std::move(traced.map);
    photons.report = traced.report;
    photons.store = settings.store;
    photons.emission = settings.emission;
    return photons;
}

void Workbench::record_paths(Photons& photons, const Scene& scene, TraceSettings settings, const Progress& progress) {
    const std::lock_guard lock(*photons.mutex);
    if (photons.map.paths)
        return;
    settings.emitted = photons.report.emitted;
    settings.paths = true;
    const std::shared_ptr<Photons> traced = trace_photons(scene, settings, progress);
    std::array<double, 3> shift{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        shift[axis] = traced->map.origin[axis] - photons.map.origin[axis];
    const std::vector<std::uint32_t> ids =
        find_traced(traced->map, read_emitted_indices(photons.map), read_traced_positions(photons));
    photons.map.paths = select_paths(m_device, *traced->map.paths, traced->map.count, ids, shift);
}

std::shared_ptr<const script::ScriptRun> Workbench::run_script(Photons& photons, const script::CompiledScript& script,
                                                               const script::RunSettings& settings, bool keeps,
                                                               const Progress& progress) {
    MemoKey key = make_key(photons, script, settings, keeps);
    std::shared_ptr<const ScriptedPhotons> scripted = m_scripted.recall(key);
    if (scripted) {
        take_script_columns(photons, *scripted->photons);
    } else {
        script::ScriptRun run = run_anew(photons, script, settings, keeps, progress);
        const bool is_whole = run.stopped.empty(); // what time or a limit stopped may get farther
        photons.scripted_by.reset();
        scripted = std::make_shared<const ScriptedPhotons>(ScriptedPhotons{std::move(run), share_photons(photons)});
        if (is_whole)
            m_scripted.remember(std::move(key), scripted);
    }
    photons.scripted_by = scripted;
    return {scripted, &scripted->run};
}

script::ScriptRun Workbench::run_anew(Photons& photons, const script::CompiledScript& script,
                                      const script::RunSettings& settings, bool keeps, const Progress& progress) {
    script::require_columns(script.program, photons.map);
    const std::shared_ptr<const Photons> before = share_photons(photons);
    const script::ScriptQueries queries{
        [&](script::NeighborQuery::Space space, std::span<const std::uint32_t> ids, std::uint32_t k, float beta) {
            const NearestQuery query{choose_space(space), ids, {}, {}, k, beta};
            return find_neighbors(m_device, photons, query, progress).ids;
        },
        [&](std::span<const float> values, const std::vector<script::DeclaredParameter>& declared) {
            set_parameters(m_device, photons, {values.begin(), values.end()}, list_axes(declared));
        }};
    try {
        if (!keeps)
            set_parameters(m_device, photons, {}, {});
        script::ScriptRun run = script::run_script(m_device, photons.map, script, settings, keeps, queries, progress);
        set_parameters(m_device, photons, std::move(run.values), list_axes(script::list_declared(run)));
        photons.map.colors.reset();
        photons.map.given_colors.reset();
        if (run.colors)
            set_colors(m_device, photons.map, *std::exchange(run.colors, std::nullopt));
        return run;
    } catch (...) {
        take_script_columns(photons, *before);
        throw;
    }
}

std::shared_ptr<Photons> Workbench::take_relaxed(const Photons& source, RelaxedColumns columns) {
    auto photons = std::make_shared<Photons>();
    const std::lock_guard lock(*source.mutex);
    PhotonMap before = share_map(source.map);
    photons->map = std::move(columns.map);
    photons->map.paths = std::move(before.paths);
    photons->map.parameters = std::move(before.parameters);
    photons->map.colors = std::move(before.colors);
    photons->map.given_colors = std::move(before.given_colors);
    photons->map.long_indices = std::move(before.long_indices);
    photons->report = source.report;
    photons->store = source.store;
    photons->emission = source.emission;
    columns.state.traced = read_traced_positions(source);
    photons->state = std::make_shared<const RelaxedState>(std::move(columns.state));
    return photons;
}

Relaxation Workbench::start_relaxation(Photons& photons, const Scene* scene, const RelaxSettings& given,
                                       const Progress& progress) {
    const CompleteSettings complete = complete_settings(m_device, photons, given, photons.emission, progress);
    const RelaxSettings& settings = complete.settings;
    RelaxTrees trees{find_tree(m_device, photons, progress), nullptr, nullptr};
    if (settings.uses_layers()) {
        const bool seeks_constraint = settings.constrains() && settings.constraint == Space::parameter;
        const LayerReach reach{seeks_constraint ? *settings.constraint_neighbors : settings.neighbors,
                               static_cast<float>(*settings.beta)};
        trees.by_parameters = find_parameter_tree(m_device, photons, progress);
        trees.layered = find_layered_tree(m_device, photons, progress, reach);
    }
    RelaxSurface surface;
    if (scene && settings.surface == SurfaceChoice::automatic)
        surface = {find_buffers(*scene), scene->origin};
    return Relaxation(m_device, photons.map, trees, complete, surface, progress);
}

RelaxedRun Workbench::relax_photons(Photons& photons, const Scene* scene, const RelaxSettings& settings,
                                    const Progress& progress) {
    const std::shared_ptr<const RelaxedRun> relaxed = m_relaxed.find(make_key(photons, scene, settings), [&] {
        Relaxation relaxation = start_relaxation(photons, scene, settings, progress);
        RelaxedRun run;
        run.settings = relaxation.settings();
        while (relaxation.step_count() < run.settings.steps.value())
            run.steps.push_back(relaxation.step(progress));
        run.notes = relaxation.notes();
        run.off_surface_count = relaxation.count_off_surface();
        run.photons = take_relaxed(photons, relaxation.read());
        return run;
    });
    RelaxedRun run = *relaxed;
    run.photons = share_photons(*relaxed->photons);
    run.photons->made_by = relaxed;
    const std::lock_guard lock(*photons.mutex);
    run.photons->map.paths = share_map(photons.map).paths; // they may have been recorded since
    return run;
}

gpu::Buffer Workbench::estimate_irradiance(Photons& photons, std::span<const glm::vec4> points,
                                           std::span<const glm::vec4> normals, const EstimateSettings& given,
                                           const Progress& progress) {
    const EstimateSettings settings = complete_settings(given, photons.emission);
    require_k(*settings.k);
    return m_irradiance
        .find(make_key(photons, points, normals, settings),
              [&] {
                  return estimate_irradiance_at(m_device, photons.map.power_object,
                                                *find_tree(m_device, photons, progress), points, normals, settings,
                                                progress);
              })
        ->share();
}

gpu::Buffer Workbench::estimate_fluence(Photons& photons, const Scene& scene, std::span<const glm::vec4> points,
                                        const EstimateSettings& given, const Progress& progress) {
    return estimate_fluence_at(m_device, scene, take_media_photons(m_device, photons.map, progress), points,
                               choose_k(given, photons.emission), progress);
}

Image Workbench::render_voronoi(const Scene& scene, Photons& photons, const CameraChoice& looks,
                                const RenderSettings& settings, const Progress& progress) {
    const shared::CameraFrame camera =
        frame_camera(scene.origin, find_camera(scene, looks), settings.width, settings.height);
    const inspect::SurfaceView view = inspect::see_surfaces(m_device, scene, *find_buffers(scene), camera,
                                                            {settings.width, settings.height}, progress);
    const inspect::CellImage cells =
        inspect::find_voronoi_cells(m_device, photons.map, *find_tree(m_device, photons, progress), view, {}, progress);
    return inspect::paint_cells(cells, inspect::list_encoded_colors(photons.map));
}

Image Workbench::render(const Scene& scene, Photons* photons, const CameraChoice& camera, const RenderSettings& given,
                        const Progress& progress) {
    RenderSettings settings = given;
    settings.estimate = complete_settings(given.estimate, photons ? photons->emission : std::nullopt);
    if (std::uint64_t{settings.width} * settings.height > MOST_REMEMBERED_PIXELS)
        return render_anew(scene, photons, camera, settings, progress);
    return *m_image.find(make_key(scene, photons, camera, settings),
                         [&] { return render_anew(scene, photons, camera, settings, progress); });
}

void Workbench::forget() {
    m_emitters.forget();
    m_traced.forget();
    m_scripted.forget();
    m_relaxed.forget();
    m_irradiance.forget();
    m_image.forget();
}

Image Workbench::render_anew(const Scene& scene, Photons* photons, const CameraChoice& camera,
                             const RenderSettings& settings, const Progress& progress) {
    if (!photons)
        return render_image(m_device, scene, *find_buffers(scene), nullptr, camera, settings, progress);
    if (settings.mode == RenderMode::voronoi)
        return render_voronoi(scene, *photons, camera, settings, progress);
    const bool needs_tree = settings.mode != RenderMode::photons;
    m_device.compile_ahead(list_render_kernels(scene, photons->store, settings));
    if (needs_tree && !has_tree(*photons))
        expect_tree(m_device, photons->map.count);
    const std::shared_ptr<const KdTree> tree =
        needs_tree ? find_tree(m_device, *photons, progress) : std::make_shared<const KdTree>();
    const RenderedMap map{photons->map, *tree, photons->store};
    return render_image(m_device, scene, *find_buffers(scene), &map, camera, settings, progress);
}

} // namespace photonloupe
