// SPDX-License-Identifier: Apache-2.0
// Commands of editing, scripts, view and selection.
#include "studio/edit_state.h"

#include <algorithm>

#include <imgui.h>

#include "core/error.h"
#include "inspect/histogram.h"
#include "photons/map_columns.h"
#include "studio/python_script.h"

namespace photonloupe::studio {
namespace {

// Places, parameters, signature.
std::vector<AxisState> choose_axes(Workspace& workspace) {
    std::vector<AxisState> axes;
    const auto add = [&](const std::string& name, bool is_closed) {
        AxisState axis;
        axis.name = name;
        axis.is_closed = is_closed;
        axes.push_back(axis);
    };
    for (const char* name : {"x", "y", "z"})
        add(name, false);
    const Photons* photons = workspace.shown();
    if (photons && photons->map.parameters)
        for (std::size_t i = 0; i < photons->map.parameters->axes.size(); ++i)
            add(workspace.list_parameters()[i], photons->map.parameters->axes[i].period > 0);
    for (const inspect::ColumnInfo& info : workspace.list_columns())
        if (info.missing.empty() && (info.name == "signature" || (axes.size() < 6 && info.name.starts_with("primal_"))))
            add(info.name, info.period > 0);
    return axes;
}

void step_history(Workspace& workspace, const char* verb, const std::string& name,
                  bool (History::*step)(StudioState& state)) {
    if (!(workspace.history.*step)(workspace.state))
        return workspace.say(std::string("there is nothing to ") + verb);
    ++workspace.selection_version;
    ++workspace.loupe_version;
    workspace.say(std::string(verb) + "ne: " + name);
}

} // namespace

void undo(Workspace& workspace) {
    step_history(workspace, "undo", workspace.history.undo_name(), &History::undo);
}

void redo(Workspace& workspace) {
    step_history(workspace, "redo", workspace.history.redo_name(), &History::redo);
}

void copy_python(Workspace& workspace) {
    ImGui::SetClipboardText(write_program(workspace).c_str());
    workspace.say("the Python of this state is on the clipboard");
}

void save_session_command(Workspace& workspace) {
    workspace.requests.push_back("save_session");
}

void run_script(Workspace& workspace) {
    const std::string& text = workspace.state.script.text;
    workspace.script.check(text, workspace.state.script.path.empty() ? "script" : workspace.state.script.path);
    if (text.empty()) {
        workspace.say("there is no script to run; write one, or choose an example", true);
        return;
    }
    if (workspace.script.has_errors()) {
        workspace.say("the script has errors; the last good run stays", true);
        return;
    }
    workspace.change("run script", [](StudioState& state) { state.script.ran = state.script.text; });
    workspace.done.erase("script"); // the same text runs again
}

void open_next_example(Workspace& workspace) {
    if (workspace.examples.empty()) {
        workspace.say("no example scripts were found");
        return;
    }
    std::size_t next = 0;
    for (std::size_t i = 0; i < workspace.examples.size(); ++i)
        if (workspace.examples[i].path == workspace.state.script.path)
            next = (i + 1) % workspace.examples.size();
    open_script(workspace, workspace.examples[next].path, workspace.examples[next].text);
}

void open_script(Workspace& workspace, const std::string& path, const std::string& text) {
    workspace.change("open script", [&](StudioState& state) {
        state.script.path = path;
        state.script.text = text;
        state.script.values.clear();
    });
}

void add_key_light(Workspace& workspace) {
    workspace.change("add a light", [](StudioState& state) {
        state.trace.additions.emplace_back(R"({"add": "light", "kind": "auto"})");
    });
    workspace.say("");
}

void add_floor(Workspace& workspace) {
    workspace.change("add a floor",
                     [](StudioState& state) { state.trace.additions.emplace_back(R"({"add": "floor"})"); });
    workspace.say("");
}

void set_mode(Workspace& workspace, ViewMode mode) {
    workspace.change("view", [&](StudioState& state) { state.view.mode = mode; });
}

void toggle_relaxed(Workspace& workspace) {
    if (!workspace.has_relaxed()) {
        workspace.say("nothing is relaxed yet; Relaxation / Run does it");
        return;
    }
    workspace.change("before or after",
                     [](StudioState& state) { state.view.shows_relaxed = !state.view.shows_relaxed; });
    ++workspace.loupe_version;
}

void toggle_split(Workspace& workspace) {
    if (!workspace.has_relaxed() && !workspace.state.view.is_split) {
        workspace.say("nothing is relaxed yet; Relaxation / Run does it");
        return;
    }
    workspace.change("side by side", [](StudioState& state) { state.view.is_split = !state.view.is_split; });
}

std::optional<Bounds> find_photon_box(const Photons& photons, const Ids& ids) {
    constexpr double OUTLIERS = 0.005; // share beyond either end that a frame of all photons leaves out
    const std::vector<float> positions = read_positions(photons.map);
    Bounds box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<float> values;
        for (std::size_t i = 0; i < (ids ? ids->size() : photons.map.count); ++i)
            if (const std::size_t photon = ids ? (*ids)[i] : i; photon < photons.map.count)
                values.push_back(positions[3 * photon + axis]);
        if (values.empty())
            return std::nullopt;
        box.lo[axis] = inspect::find_quantile(values, ids ? 0.0 : OUTLIERS);
        box.hi[axis] = inspect::find_quantile(values, ids ? 1.0 : 1.0 - OUTLIERS);
    }
    return box;
}

void frame_selection(Workspace& workspace) {
    const Photons* photons = workspace.shown();
    const std::optional<Bounds> box = photons ? find_photon_box(*photons, workspace.state.selection) : std::nullopt;
    if (!box) {
        workspace.say("there are no photons to frame; open a scene");
        return;
    }
    workspace.change("frame", [&](StudioState& state) { fit_box(state.view.camera, *box); });
}

void look_straight(Workspace& workspace) {
    glm::vec3 normal(0, 1, 0);
    if (workspace.loupe && workspace.loupe->center)
        normal = workspace.loupe->center_normal;
    workspace.change("look straight", [&](StudioState& state) { face_normal(state.view.camera, normal); });
}

void clear_selection(Workspace& workspace) {
    if (workspace.shows_keys) {
        workspace.shows_keys = false; // Escape closes what is open first
        return;
    }
    select_instead(workspace, "select nothing", nullptr);
}

void select_instead(Workspace& workspace, const char* name, Ids ids) {
    workspace.change(name, [&](StudioState& state) {
        for (AxisState& axis : state.parallel.axes)
            axis.brushes.clear();
        workspace.select(std::move(ids));
    });
}

void reset_axes(Workspace& workspace) {
    workspace.change("reset axes", [&](StudioState& state) {
        state.parallel.axes.clear(); // chosen anew for the photons there are
        workspace.select(nullptr);
    });
}

std::vector<AxisState> list_axes(Workspace& workspace) {
    const std::vector<AxisState>& chosen = workspace.state.parallel.axes;
    return chosen.empty() && workspace.shown() ? choose_axes(workspace) : chosen;
}

StudioState complete_state(Workspace& workspace) {
    StudioState state = workspace.state;
    state.parallel.axes = list_axes(workspace);
    for (AxisState& axis : state.parallel.axes) {
        const inspect::Column* column = axis.low == axis.high ? workspace.seek_column(axis.name) : nullptr;
        if (column) {
            axis.low = column->low;
            axis.high = column->high;
        }
    }
    return state;
}

std::string write_program(Workspace& workspace) {
    StudioState state = complete_state(workspace);
    // What the script no longer exposes is of an earlier text.
    workspace.script.check(state.script.text, state.script.path.empty() ? "script" : state.script.path);
    if (const script::CompiledScript* compiled = workspace.script.compiled();
        compiled && state.script.ran == state.script.text)
        std::erase_if(state.script.values, [&](const auto& entry) {
            return std::none_of(compiled->program.exposed.begin(), compiled->program.exposed.end(),
                                [&](auto index) { return compiled->program.variables[index].name == entry.first; });
        });
    return write_python(state, workspace.list_parameters());
}

void toggle_keys(Workspace& workspace) {
    workspace.shows_keys = !workspace.shows_keys;
    workspace.focus = "Keys";
}

} // namespace photonloupe::studio
