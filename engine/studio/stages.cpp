// SPDX-License-Identifier: Apache-2.0
// Runs the pipeline and hands over what it gives.
#include "studio/stages.h"

#include <chrono>
#include <filesystem>
#include <sstream>

#include "core/hash.h"
#include "estimate/camera_frame.h"
#include "relax/isotropy.h"
#include "relax/measure_evenness.h"
#include "scene/edit_scene.h"
#include "script/compile_script.h"
#include "studio/python_script.h"
#include "studio/stage_choices.h"
#include "studio/workspace.h"

namespace photonloupe::studio {
namespace {

class Stopwatch {
public:
    double milliseconds() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - m_start).count();
    }

private:
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

bool is_same_file(const std::string& a, const std::string& b) {
    using std::filesystem::absolute;
    return absolute(a).lexically_normal() == absolute(b).lexically_normal();
}

script::RunSettings choose_values(const script::Program& program, const ScriptState& state) {
    script::RunSettings settings;
    for (const std::uint32_t index : program.exposed)
        if (const auto value = state.values.find(program.variables[index].name); value != state.values.end())
            settings.values.insert(*value);
    return settings;
}

} // namespace

void Stages::run(const Job& job, const Progress& progress) {
    constexpr std::pair<const char*, void (Stages::*)(const Job&, const Progress&)> STAGES[] = {
        {"trace", &Stages::trace},
        {"map", &Stages::load_map},
        {"script", &Stages::run_script},
        {"relax", &Stages::relax},
        {"isotropy", &Stages::measure_isotropy},
        {"render", &Stages::render},
        {"reference", &Stages::compare},
    };
    const Stopwatch watch;
    for (const auto& [kind, stage] : STAGES)
        if (job.kind == kind)
            (this->*stage)(job, progress);
    m_milliseconds[job.kind] = watch.milliseconds();
    m_deliver([times = m_milliseconds](Workspace& workspace) { workspace.stage_milliseconds = times; });
}

void Stages::open_scene(std::shared_ptr<const Scene> scene) {
    const std::lock_guard lock(m_mutex);
    m_opened = std::move(scene);
}

Made Stages::made() const {
    const std::lock_guard lock(m_mutex);
    return m_made;
}

void Stages::say(std::string text) {
    m_deliver([text = std::move(text)](Workspace& workspace) { workspace.say(text); });
}

std::shared_ptr<const Scene> Stages::find_scene(const TraceState& trace) {
    std::shared_ptr<const Scene> scene;
    {
        const std::lock_guard lock(m_mutex);
        scene = m_opened ? std::exchange(m_opened, nullptr) : m_made.scene;
    }
    if (scene && is_same_file(scene->path, trace.scene) && scene->additions == trace.additions)
        return scene;
    Scene loaded = load_scene(trace.scene);
    for (const std::string& addition : trace.additions)
        loaded = add_to_scene(loaded, addition);
    return std::make_shared<const Scene>(std::move(loaded));
}

void Stages::trace(const Job& job, const Progress& progress) {
    TraceSettings settings = job.state.trace;
    settings.paths = true;
    const std::shared_ptr<const Scene> scene = find_scene(job.state.trace);
    take_photons(scene, m_bench.trace_photons(*scene, settings, progress), settings, nullptr, progress);
}

void Stages::load_map(const Job& job, const Progress& progress) {
    const LoadedMap loaded = m_host.load_map(job.state.trace.map);
    take_photons(loaded.scene, loaded.photons, std::nullopt, loaded.origin, progress);
    for (const std::string& remark : loaded.remarks)
        say(remark);
}

void Stages::take_photons(std::shared_ptr<const Scene> scene, std::shared_ptr<Photons> photons,
                          std::optional<TraceSettings> trace, std::shared_ptr<void> origin, const Progress& progress) {
    if (photons->map.count == 0)
        throw Error("there are no photons to look at; trace more, or another store");
    show(photons, false, progress, [&](Made& made) {
        made.scene = scene;
        made.trace = trace;
        made.origin = origin;
        made.traced = photons;
        made.script = nullptr;
    });
}

// `tell` says in the same moment where they come from.
void Stages::show(std::shared_ptr<Photons> photons, bool has_same_paths, const Progress& progress,
                  const std::function<void(Made&)>& tell) {
    build_view_trees(m_bench.device(), *photons, progress);
    m_relaxation.reset();
    make([&](Made& made) {
        made.photons = photons;
        made.relaxed = nullptr;
        tell(made);
    });
    m_deliver([scene = m_made.scene, photons, has_same_paths](Workspace& workspace) {
        workspace.take_photons(scene, photons, has_same_paths);
    });
}

void Stages::run_script(const Job& job, const Progress& progress) {
    if (!m_made.traced)
        throw Error("there are no photons to run the script over; open a scene");
    const ScriptState& state = job.state.script;
    if (state.ran.empty()) {
        if (m_made.photons != m_made.traced) {
            m_deliver([](Workspace& workspace) { workspace.results.script.reset(); });
            show(m_made.traced, true, progress, [](Made& made) { made.script = nullptr; });
        }
        return;
    }
    const std::string name = std::filesystem::path(state.path).filename().string();
    const auto compiled = script::compile_script({name.empty() ? "script" : name, state.ran});
    script::require_script(*compiled);
    const std::shared_ptr<Photons> target = share_photons(*m_made.traced);
    const Stopwatch watch;
    const auto run = m_bench.run_script(*target, *compiled, choose_values(compiled->program, state), false, progress);
    ScriptResult result = describe_run(*run, compiled->program.source);
    result.milliseconds = watch.milliseconds();
    show(target, true, progress, [&](Made& made) {
        made.script = run;
        made.script_name = compiled->program.source.name;
        made.script_hash = hash_bytes(state.ran);
    });
    m_deliver([result = std::move(result)](Workspace& workspace) { workspace.results.script = result; });
}

void Stages::relax(const Job& job, const Progress& progress) {
    const std::uint32_t wanted = job.state.relax.made;
    const RelaxSettings& settings = job.state.relax.used;
    if (!m_relaxation || settings != m_relaxed_with || m_relaxation->step_count() > wanted) {
        m_relaxation.reset();
        m_relaxation = std::make_unique<Relaxation>(
            m_bench.start_relaxation(*m_made.photons, m_made.scene.get(), settings, progress));
        m_relaxed_with = settings;
        m_steps.clear();
        make([&](Made& made) {
            made.relaxation = {};
            made.relaxation.settings = m_relaxation->settings();
            made.relaxation.notes = m_relaxation->notes();
        });
        for (const std::string& note : m_relaxation->notes())
            say(note);
    }
    try {
        while (m_relaxation->step_count() < wanted) {
            const StepReport step = m_relaxation->step(progress);
            const Evenness even =
                measure_evenness(m_relaxation->sample_distances(EVENNESS_SAMPLE, EVENNESS_NEIGHBORS, progress));
            m_steps.push_back({step.mean_metres, step.mean_move, even.low_frequency, even.noise});
            make([&](Made& made) { made.relaxation.steps.push_back(step); });
            m_deliver([steps = m_steps](Workspace& workspace) { workspace.results.steps = steps; });
            progress.report("relax", static_cast<double>(m_relaxation->step_count()) / wanted);
        }
    } catch (const Cancelled&) {
        show_relaxed(true);
        throw;
    }
    show_relaxed(false);
}

// The photons as far as they are relaxed; stopped half way, those steps stay.
void Stages::show_relaxed(bool is_stopped) {
    const std::shared_ptr<Photons> relaxed = Workbench::take_relaxed(*m_made.photons, m_relaxation->read());
    build_view_trees(m_bench.device(), *relaxed);
    make([&](Made& made) {
        made.relaxed = relaxed;
        made.relaxation.off_surface_count = m_relaxation->count_off_surface();
    });
    m_deliver([=, steps = m_steps, count = m_relaxation->step_count()](Workspace& workspace) {
        workspace.take_relaxed(relaxed, steps);
        if (is_stopped)
            workspace.state.relax.made = std::min(workspace.state.relax.made, count);
    });
}

void Stages::measure_isotropy(const Job&, const Progress& progress) {
    Photons& photons = *m_made.photons;
    const auto found = find_optimal_beta(m_bench.device(), photons, BETA_NEIGHBORS, CLIPPED_SHARE, progress);
    if (!found)
        throw Error(explain_no_ratio(photons.map));
    std::ostringstream text;
    text.precision(4);
    text << "β = " << found->beta << " from t_β = " << found->threshold;
    m_deliver([found = *found, text = text.str()](Workspace& workspace) {
        workspace.take_isotropy({found.isotropy, found.beta, found.threshold});
        workspace.say(text);
    });
}

void Stages::render(const Job& job, const Progress& progress) {
    if (!m_made.scene)
        throw Error("rendering needs the scene the photons were traced in; open it");
    const bool is_relaxed = shows_relaxed(job.state) && m_made.relaxed;
    Photons& photons = is_relaxed ? *m_made.relaxed : *m_made.photons;
    RenderSettings settings = job.state.image.render;
    settings.width = RENDER_WIDTH;
    settings.height = RENDER_HEIGHT;
    settings.mode = RenderMode::composite;
    const CameraPose& pose = job.camera;
    const CameraChoice camera{{}, aim_camera(pose.position, pose.target, pose.up, pose.yfov)};
    const auto image =
        std::make_shared<const Image>(m_bench.render(*m_made.scene, &photons, camera, settings, progress));
    make([&](Made& made) {
        made.image = image;
        made.render = settings;
        made.camera = pose;
        made.is_relaxed = is_relaxed;
    });
    std::optional<Image> colors;
    if (photons.map.given_colors) {
        settings.mode = RenderMode::false_color;
        colors = m_bench.render(*m_made.scene, &photons, camera, settings, progress);
    }
    m_deliver([image, colors = std::move(colors)](Workspace& workspace) {
        workspace.results.image = *image;
        workspace.results.colors = colors;
        ++workspace.results.image_version;
    });
}

void Stages::compare(const Job& job, const Progress&) {
    if (!m_made.image)
        return;
    const Comparison comparison = m_host.compare(*m_made.image, job.state.image.reference);
    m_deliver([comparison](Workspace& workspace) {
        workspace.results.reference = comparison.reference;
        workspace.results.error = comparison.error;
        workspace.results.comparison.reset();
        if (comparison.error)
            workspace.results.comparison = comparison.result;
        ++workspace.results.image_version;
    });
    if (!comparison.reason.empty())
        throw Error(comparison.reason);
}

} // namespace photonloupe::studio
