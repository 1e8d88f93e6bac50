// SPDX-License-Identifier: Apache-2.0
// The studio's work: each job by the pipeline's stages, so that what is shown is what Python gives.
#pragma once

#include <functional>
#include <mutex>

#include "studio/results.h"
#include "studio/work.h"

namespace photonloupe::studio {

struct Workspace;

// A map from a file, as its host reads it.
struct LoadedMap {
    std::shared_ptr<void> origin; // what the host keeps of it, given back as it is
    std::shared_ptr<Photons> photons;
    std::shared_ptr<const Scene> scene; // null: it is not there, or has changed
    std::vector<std::string> remarks;   // what is missing, and why
};

// A picture against another from a file; without an error map they cannot be compared, for that reason.
struct Comparison {
    Image reference;
    std::optional<Image> error;
    ComparisonResult result;
    std::string reason;
};

// What another program does for the studio: its file formats and measures.
struct Host {
    std::function<LoadedMap(const std::string& path)> load_map;
    std::function<Comparison(const Image& image, const std::string& reference)> compare;
};

// What the stages have made last.
struct Made {
    std::shared_ptr<const Scene> scene;
    std::optional<TraceSettings> trace; // none: the photons came from a file
    std::shared_ptr<void> origin;       // then: what the host keeps of it
    std::shared_ptr<Photons> traced;
    std::shared_ptr<Photons> photons;                // with what the script gave them
    std::shared_ptr<const script::ScriptRun> script; // null: none ran over them
    std::string script_name, script_hash;
    std::shared_ptr<Photons> relaxed;
    RelaxedRun relaxation; // that gave them, without photons
    std::shared_ptr<const Image> image;
    RenderSettings render; // of the image
    CameraPose camera;
    bool is_relaxed = false; // the photons it shows
};

using Deliver = std::function<void(std::function<void(Workspace&)>)>;

// What a script run gave, as the studio tells it.
ScriptResult describe_run(const script::ScriptRun& run, const script::Source& source);

// One thread works; photons that the interface shows are never changed: a script runs over others in the same memory.
class Stages {
public:
    // `deliver` hands a change to the interface.
    Stages(Workbench& bench, Host host, Deliver deliver)
        : m_bench(bench), m_host(std::move(host)), m_deliver(std::move(deliver)) {}

    // Does a job and hands its result to the interface. Throws what went wrong; what was there stays.
    void run(const Job& job, const Progress& progress);

    // For any thread: takes a scene's place when photons are traced next.
    void open_scene(std::shared_ptr<const Scene> scene);
    // For any thread.
    Made made() const;

private:
    void trace(const Job& job, const Progress& progress);
    void load_map(const Job& job, const Progress& progress);
    void take_photons(std::shared_ptr<const Scene> scene, std::shared_ptr<Photons> photons,
                      std::optional<TraceSettings> trace, std::shared_ptr<void> origin, const Progress& progress);
    void run_script(const Job& job, const Progress& progress);
    void show(std::shared_ptr<Photons> photons, bool has_same_paths, const Progress& progress,
              const std::function<void(Made&)>& tell);
    void relax(const Job& job, const Progress& progress);
    void show_relaxed(bool is_stopped);
    void measure_isotropy(const Job& job, const Progress& progress);
    void render(const Job& job, const Progress& progress);
    void compare(const Job& job, const Progress& progress);

    std::shared_ptr<const Scene> find_scene(const TraceState& trace);
    void say(std::string text);
    template <class Change>
    void make(const Change& change) {
        Made before; // what goes does so without the lock: a host's photons may wait for the host
        const std::lock_guard lock(m_mutex);
        before = m_made;
        change(m_made);
    }

    Workbench& m_bench;
    Host m_host;
    Deliver m_deliver;
    mutable std::mutex m_mutex; // of what other threads reach
    std::shared_ptr<const Scene> m_opened;
    Made m_made;
    std::unique_ptr<Relaxation> m_relaxation; // of the photons that were made, as they were told
    RelaxSettings m_relaxed_with;
    std::vector<StepResult> m_steps;
    std::map<std::string, double> m_milliseconds;
};

} // namespace photonloupe::studio
