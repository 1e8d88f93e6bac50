// SPDX-License-Identifier: Apache-2.0
// The program on one page: the stages in the order they run. Everything else delegates to a stage's folder.
//
//   load_scene → trace_photons → run_script → relax_photons → estimate_irradiance / render → save
#pragma once

#include "core/memo.h"
#include "estimate/render_image.h"
#include "known_photons.h"
#include "relax/relaxation.h"
#include "script/run/run_script.h"
#include "trace/trace_photons.h"

namespace photonloupe {

// What all steps of a relaxation gave; settings are complete.
struct RelaxedRun {
    std::shared_ptr<Photons> photons;
    RelaxSettings settings;
    std::vector<StepReport> steps;
    std::vector<std::string> notes;
    std::uint64_t off_surface_count = 0;
};

// What a script gave, and photons with its columns; their values are no longer in `run`.
struct ScriptedPhotons {
    script::ScriptRun run;
    std::shared_ptr<const Photons> photons;
};

// Runs the stages on one device, for any number of threads, and remembers what they gave last: a stage whose inputs did
// not change does not run again.
class Workbench {
public:
    explicit Workbench(gpu::Device& device) : m_device(device) {}

    std::shared_ptr<Photons> trace_photons(const Scene& scene, const TraceSettings& settings, const Progress& progress);

    // Gives photons the paths they had, by tracing the same emitted indices again.
    void record_paths(Photons& photons, const Scene& scene, TraceSettings settings, const Progress& progress);

    // Gives the photons the parameters and colors that a script computes; those that it does not set go, or are kept.
    // On an exception they keep what they have.
    std::shared_ptr<const script::ScriptRun> run_script(Photons& photons, const script::CompiledScript& script,
                                                        const script::RunSettings& settings, bool keeps,
                                                        const Progress& progress);

    // All steps of a relaxation; `scene` may be null.
    RelaxedRun relax_photons(Photons& photons, const Scene* scene, const RelaxSettings& settings,
                             const Progress& progress);

    // Measures the constraint and stands ready for the first step; `scene` may be null. The photons must outlive it.
    Relaxation start_relaxation(Photons& photons, const Scene* scene, const RelaxSettings& settings,
                                const Progress& progress);

    // The photons where a relaxation put them, with what it measured; paths keep their traced end points.
    static std::shared_ptr<Photons> take_relaxed(const Photons& source, RelaxedColumns columns);

    gpu::Buffer estimate_irradiance(Photons& photons, std::span<const glm::vec4> points,
                                    std::span<const glm::vec4> normals, const EstimateSettings& settings,
                                    const Progress& progress);

    // W/m² inside of media, `points` relative to the map's origin.
    gpu::Buffer estimate_fluence(Photons& photons, const Scene& scene, std::span<const glm::vec4> points,
                                 const EstimateSettings& settings, const Progress& progress);

    // `photons` may be null for direct light alone.
    Image render(const Scene& scene, Photons* photons, const CameraChoice& camera, const RenderSettings& settings,
                 const Progress& progress);

    // The scene on the device, kept until another one is asked for.
    std::shared_ptr<const SceneBuffers> find_buffers(const Scene& scene);

    // The scene's lights as a store of photons draws from them, kept like its buffers.
    std::shared_ptr<const EmitterTable> find_emitters(const Scene& scene, Store store);

    // All stages run again, whatever they are asked: for measuring.
    void forget();

    gpu::Device& device() { return m_device; }

private:
    Image render_voronoi(const Scene& scene, Photons& photons, const CameraChoice& looks,
                         const RenderSettings& settings, const Progress& progress);

    Photons trace_anew(const Scene& scene, const TraceSettings& settings, const Progress& progress);
    script::ScriptRun run_anew(Photons& photons, const script::CompiledScript& script,
                               const script::RunSettings& settings, bool keeps, const Progress& progress);
    Image render_anew(const Scene& scene, Photons* photons, const CameraChoice& camera, const RenderSettings& settings,
                      const Progress& progress);

    gpu::Device& m_device;
    Memo<SceneBuffers> m_scene_buffers{Lifetime::until_next};
    Memo<EmitterTable> m_emitters{Lifetime::until_next};
    Memo<Photons> m_traced{Lifetime::while_held}; // by those that share its columns
    Memo<ScriptedPhotons> m_scripted{Lifetime::while_held};
    Memo<RelaxedRun> m_relaxed{Lifetime::while_held};
    Memo<gpu::Buffer> m_irradiance{Lifetime::until_next};
    Memo<Image> m_image{Lifetime::until_next};
};

} // namespace photonloupe
