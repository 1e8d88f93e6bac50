// SPDX-License-Identifier: Apache-2.0
// Compares what the state asks for with what has been done.
#include "studio/work.h"

#include <nlohmann/json.hpp>

#include "core/setting_json.h"
#include "studio/camera.h"
#include "studio/stage_choices.h"

namespace photonloupe::studio {
namespace {

using Settings = nlohmann::json;

// By the names that Python has for them.
Settings write_settings(const std::vector<Setting>& settings) {
    Settings written = Settings::object();
    for (const Setting& setting : settings)
        written[setting.about.name] = write_json(setting);
    return written;
}

Settings describe_trace(const TraceState& trace) {
    if (!trace.map.empty())
        return {{"map", trace.map}};
    TraceState copy = trace;
    return {{"scene", trace.scene}, {"settings", write_settings(list_settings<TraceSettings>(copy))}};
}

Settings describe_camera(const CameraPose& pose) {
    return {{"position", pose.position}, {"right", pose.right},   {"up", pose.up},
            {"backward", pose.backward}, {"target", pose.target}, {"yfov", pose.yfov}};
}

// Adds a job unless it has been done; returns true when it has to be done first.
bool ask(std::optional<Job>& job, const DoneWork& done, const char* kind, const std::string& key, Settings settings) {
    const auto found = done.find(kind);
    if (found != done.end() && found->second == key)
        return false;
    job = Job{kind, key, settings.dump(-1, ' ', false, Settings::error_handler_t::replace)};
    return true;
}

} // namespace

std::optional<Job> plan_work(const StudioState& state, const CameraPose& camera, const Wanted& wanted,
                             const Holding& holding, const DoneWork& done) {
    std::optional<Job> job;
    const Settings trace = describe_trace(state.trace);
    const std::string trace_key = trace.dump();
    if (state.trace.scene.empty() && state.trace.map.empty())
        return job;
    if (ask(job, done, state.trace.map.empty() ? "trace" : "map", trace_key, trace))
        return job;
    if (!holding.photons)
        return job;
    // Without a script the photons are as they were traced.
    std::string script_key = trace_key;
    Settings script{{"text", ""}};
    if (!state.script.ran.empty()) {
        script = {{"text", state.script.ran}, {"path", state.script.path}, {"values", state.script.values}};
        script_key += script.dump(-1, ' ', false, Settings::error_handler_t::replace);
    }
    if (ask(job, done, "script", script_key, script))
        return job;
    if (state.relax.is_wanted()) {
        RelaxSettings used = state.relax.used;
        if (!used.constraint)
            used.constraint = holding.parameters ? Space::parameter : Space::world;
        Settings relax{{"settings", write_settings(list_settings(used))}};
        const std::string settings_key = script_key + relax.dump();
        relax["made"] = state.relax.made;
        relax["settings_key"] = settings_key;
        if (ask(job, done, "relax", settings_key + std::to_string(state.relax.made), relax))
            return job;
    }
    const std::string version = std::to_string(holding.photons_version);
    if (wanted.isotropy && holding.parameters && ask(job, done, "isotropy", script_key, Settings::object()))
        return job;
    if (wanted.image && holding.scene) {
        ImageState image = state.image;
        Settings render{{"camera", describe_camera(camera)},
                        {"settings", write_settings(list_choices(image))},
                        {"relaxed", state.view.shows_relaxed && state.relax.is_wanted()}};
        if (ask(job, done, "render", version + render.dump(), render))
            return job;
        const Settings reference{{"path", state.image.reference}};
        if (!state.image.reference.empty() &&
            ask(job, done, "reference", version + render.dump() + reference.dump(), reference))
            return job;
    }
    return job;
}

} // namespace photonloupe::studio
