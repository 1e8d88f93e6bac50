// SPDX-License-Identifier: Apache-2.0
// Compares what the state asks for with what has been done.
#include "studio/work.h"

#include "core/settings.h"
#include "studio/stage_choices.h"

namespace photonloupe::studio {
namespace {

std::string write_script(const ScriptState& script) {
    std::string text = write_values(script.ran, script.path);
    for (const auto& [name, value] : script.values)
        text += write_values(name, value);
    return text;
}

} // namespace

std::string write_pose(const CameraPose& pose) {
    std::string text = write_values(pose.yfov);
    for (const auto& vector : {pose.position, pose.target, pose.up})
        text += write_values(vector[0], vector[1], vector[2]);
    return text;
}

std::optional<Job> plan_work(const StudioState& state, const CameraPose& camera, const Wanted& wanted,
                             const Holding& holding, const DoneWork& done) {
    std::optional<Job> job;
    // Plans a job unless it has been done; true when it has to be done first.
    const auto ask = [&](const char* kind, const std::string& key) {
        const auto found = done.find(kind);
        if (found != done.end() && found->second == key)
            return false;
        job = Job{kind, key, state, camera};
        return true;
    };
    if (state.trace.scene.empty() && state.trace.map.empty())
        return job;
    const bool is_traced = state.trace.map.empty();
    std::string traced = write_values(is_traced ? state.trace.scene : state.trace.map);
    if (is_traced) {
        traced += write_settings<TraceSettings>(state.trace);
        for (const std::string& addition : state.trace.additions)
            traced += write_values(addition);
    }
    if (ask(is_traced ? "trace" : "map", traced))
        return job;
    if (!holding.photons)
        return job;
    // Without a script the photons are as they were traced.
    const std::string scripted = traced + (state.script.ran.empty() ? "" : write_script(state.script));
    if (ask("script", scripted))
        return job;
    if (state.relax.is_wanted() &&
        ask("relax", scripted + write_settings(state.relax.used) + write_values(state.relax.made)))
        return job;
    if (wanted.isotropy && holding.parameters && ask("isotropy", scripted))
        return job;
    if (wanted.image && holding.scene) {
        ImageState image = state.image;
        const std::string rendered = write_values(holding.photons_version, shows_relaxed(state)) + write_pose(camera) +
                                     write_key(list_choices(image));
        if (ask("render", rendered))
            return job;
        if (!state.image.reference.empty())
            ask("reference", rendered + write_values(state.image.reference));
    }
    return job;
}

} // namespace photonloupe::studio
