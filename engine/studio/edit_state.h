// SPDX-License-Identifier: Apache-2.0
// What commands do to the state; each is one entry of the history.
#pragma once

#include "studio/workspace.h"

namespace photonloupe::studio {

void undo(Workspace& workspace);
void redo(Workspace& workspace);
void copy_python(Workspace& workspace);
void save_session_command(Workspace& workspace);

// Checks the editor's text and, if nothing is wrong with it, asks for its run.
void run_script(Workspace& workspace);
void open_next_example(Workspace& workspace);
// Takes a text into the editor.
void open_script(Workspace& workspace, const std::string& path, const std::string& text);

// To the scene's file, which traces it anew.
void add_key_light(Workspace& workspace);
void add_floor(Workspace& workspace);

void set_mode(Workspace& workspace, ViewMode mode);
template <ViewMode Mode>
void show_mode(Workspace& workspace) {
    set_mode(workspace, Mode);
}
void toggle_relaxed(Workspace& workspace);
void toggle_split(Workspace& workspace);
void frame_selection(Workspace& workspace);
void look_straight(Workspace& workspace);

void pin_photon(Workspace& workspace);
void unpin_photons(Workspace& workspace);
void lock_to_pin(Workspace& workspace);
void lock_to_brushes(Workspace& workspace);
void grow_loupe(Workspace& workspace);
void shrink_loupe(Workspace& workspace);
void change_space(Workspace& workspace);
void toggle_paths(Workspace& workspace);

// A command over the loupe, which looks anew.
template <class Change>
void change_loupe(Workspace& workspace, const std::string& name, const Change& make) {
    workspace.change(name, [&](StudioState& state) { make(state.loupe); });
    ++workspace.loupe_version;
}

void reset_axes(Workspace& workspace);
void clear_selection(Workspace& workspace);
// Selects these and clears all brushes.
void select_instead(Workspace& workspace, const char* name, Ids ids);

void measure_constraint_command(Workspace& workspace);
void step_relaxation(Workspace& workspace);
void run_relaxation(Workspace& workspace);
void reset_relaxation(Workspace& workspace);

void toggle_keys(Workspace& workspace);

// Box of the photons with these ids, or of all. Nothing where there are none.
std::optional<Bounds> find_photon_box(const Photons& photons, const Ids& ids);
// The axes shown: while nobody chose any, those that suit the photons there are.
std::vector<AxisState> list_axes(Workspace& workspace);
// The state with those axes written out.
StudioState complete_state(Workspace& workspace);
// The Python program of the state.
std::string write_program(Workspace& workspace);

} // namespace photonloupe::studio
