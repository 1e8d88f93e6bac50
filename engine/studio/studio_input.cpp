// SPDX-License-Identifier: Apache-2.0
// Input from programs, as a window would send it.
#include <algorithm>
#include <cmath>

#include <imgui.h>
#include <imgui_internal.h>

#include "core/error.h"
#include "studio/studio.h"

namespace photonloupe::studio {
namespace {

constexpr int MOUSE_BUTTONS = 3;

} // namespace

void Studio::move_mouse(float x, float y) {
    if (!std::isfinite(x) || !std::isfinite(y))
        throw Error("the mouse cannot move to a place that is not finite");
    m_context->IO.AddMousePosEvent(x, y);
}

void Studio::press_mouse(int button, bool is_down) {
    if (button < 0 || button >= MOUSE_BUTTONS)
        throw Error("mouse button " + std::to_string(button) + " is not 0 (left), 1 (right) or 2 (middle)");
    m_context->IO.AddMouseButtonEvent(button, is_down);
}

void Studio::turn_wheel(float steps) {
    if (!std::isfinite(steps))
        throw Error("the wheel cannot turn by steps that are not finite");
    m_context->IO.AddMouseWheelEvent(0, steps);
}

void Studio::press_key(const std::string& chord) {
    hold_key(chord, true);
    hold_key(chord, false);
}

void Studio::hold_key(const std::string& name, bool is_down) {
    const int parsed = parse_chord(name);
    ImGuiIO& io = m_context->IO;
    for (const int key : {int{ImGuiMod_Ctrl}, int{ImGuiMod_Shift}, int{ImGuiMod_Alt}})
        if (parsed & key)
            io.AddKeyEvent(static_cast<ImGuiKey>(key), is_down);
    if (const int key = parsed & ~ImGuiMod_Mask_)
        io.AddKeyEvent(static_cast<ImGuiKey>(key), is_down);
}

void Studio::type_text(const std::string& text) {
    ImGuiIO& io = m_context->IO;
    std::string run;
    const auto flush = [&] {
        if (!run.empty())
            io.AddInputCharactersUTF8(run.c_str());
        run.clear();
    };
    for (const char letter : text) {
        if (letter != '\n') {
            run += letter;
            continue;
        }
        flush();
        press_key("enter");
    }
    flush();
}

void Studio::drop_file(const std::string& path) {
    m_workspace.requests.push_back("open " + path);
}

std::optional<Job> Studio::take_job() {
    std::lock_guard lock(m_mutex);
    // What the last job delivered decides what is next: asked before it is taken, the same job would begin again.
    if (m_running || !m_deliveries.empty())
        return std::nullopt;
    const Workspace& workspace = m_workspace;
    const Wanted wanted{workspace.wants_render, workspace.wants_isotropy};
    const Holding holding{workspace.results.photons != nullptr, workspace.results.scene != nullptr,
                          workspace.has_parameters(), workspace.results.photons_version};
    m_running = plan_work(workspace.state, find_pose(workspace.state.view.camera), wanted, holding, workspace.done);
    m_stop = false;
    m_is_stale = false;
    m_progress = 0;
    m_progress_stage = m_running ? m_running->kind : "";
    return m_running;
}

void Studio::deliver(std::function<void(Workspace&)> change) {
    std::lock_guard lock(m_mutex);
    m_deliveries.push_back(std::move(change));
}

bool Studio::report_progress(const std::string& stage, double fraction) {
    std::lock_guard lock(m_mutex);
    m_progress_stage = stage;
    m_progress = std::clamp(fraction, 0.0, 1.0);
    return !m_stop;
}

// What was asked for may have changed meanwhile: then the result is one of the past, and plan_work asks again.
void Studio::end_job(const Job& job, const std::string& error) {
    bool is_stale = false;
    {
        std::lock_guard lock(m_mutex);
        is_stale = m_is_stale;
    }
    deliver([job, error, is_stale](Workspace& workspace) {
        if (!is_stale)
            workspace.done[job.kind] = job.key;
        // Photons are traced or loaded: one takes the other's place.
        if (job.kind == "trace" || job.kind == "map")
            workspace.done.erase(job.kind == "trace" ? "map" : "trace");
        // The script has not run over them.
        if (job.kind == "trace" || job.kind == "map")
            workspace.done.erase("script");
        workspace.failed.erase(job.kind);
        if (!error.empty()) {
            workspace.failed[job.kind] = error;
            workspace.say(error, true);
        }
    });
    std::lock_guard lock(m_mutex);
    m_running.reset();
    m_stop = false;
}

void Studio::forget_work(const std::string& kind) {
    deliver([kind](Workspace& workspace) { workspace.done.erase(kind); });
    std::lock_guard lock(m_mutex);
    m_is_stale |= m_running && m_running->kind == kind;
}

void Studio::stop_job() {
    std::lock_guard lock(m_mutex);
    m_stop = m_running.has_value();
}

} // namespace photonloupe::studio
