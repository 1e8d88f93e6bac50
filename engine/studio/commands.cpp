// SPDX-License-Identifier: Apache-2.0
// The table of commands, and the keys that run them.
#include "studio/commands.h"

#include <cctype>

#include <imgui.h>
#include <imgui_internal.h>

#include "core/error.h"
#include "studio/edit_state.h"

namespace photonloupe::studio {
namespace {

const Command COMMANDS[] = {
    {"script.run", "ctrl+enter", "Run the script over the photons", true, run_script},
    {"script.example", "", "Open the next example script", false, open_next_example},
    {"edit.undo", "ctrl+z", "Undo the last command", false, undo},
    {"edit.redo", "ctrl+y", "Redo what was undone", false, redo},
    {"edit.copy_python", "ctrl+shift+c", "Copy the Python that makes the present state", true, copy_python},
    {"session.save", "ctrl+s", "Save the session", true, save_session_command},
    {"scene.add_light", "", "Add a light that suits the scene", false, add_key_light},
    {"scene.add_floor", "", "Add a diffuse floor below the scene", false, add_floor},
    {"view.points", "1", "View: photons as points", false, show_mode<ViewMode::points>},
    {"view.voronoi", "2", "View: Voronoi cells", false, show_mode<ViewMode::voronoi>},
    {"view.kd_tree", "3", "View: partition of the kd-tree", false, show_mode<ViewMode::kd_tree>},
    {"view.colored_points", "4", "View: photons in false color", false, show_mode<ViewMode::colored_points>},
    {"view.render", "5", "View: the final render", false, show_mode<ViewMode::render>},
    {"view.colored_render", "6", "View: the render in false color", false, show_mode<ViewMode::colored_render>},
    {"view.map", "7", "View: a map of isotropy, constraint weight or drift", false, show_mode<ViewMode::map>},
    {"view.relaxed", "tab", "Before or after relaxation", false, toggle_relaxed},
    {"view.split", "s", "Before and after side by side", false, toggle_split},
    {"view.frame", "f", "Frame the selection, or all photons", false, frame_selection},
    {"view.straight", "r", "Look straight at the receiver", false, look_straight},
    {"loupe.pin", "p", "Pin the photon under the loupe", false, pin_photon},
    {"loupe.unpin", "shift+p", "Let go of all pins", false, unpin_photons},
    {"loupe.lock_pin", "l", "Lock the parameter range to the last pin, or unlock it", false, lock_to_pin},
    {"loupe.lock_brushes", "shift+l", "Lock the parameter range to the brushes, or unlock it", false, lock_to_brushes},
    {"loupe.larger", "up", "Loupe: more photons", false, grow_loupe},
    {"loupe.smaller", "down", "Loupe: fewer photons", false, shrink_loupe},
    {"loupe.space", "q", "Loupe: next query space", false, change_space},
    {"loupe.paths", "t", "Loupe: show light paths", false, toggle_paths},
    {"plot.reset", "", "Parallel coordinates: the first axes again", false, reset_axes},
    {"plot.clear_brushes", "", "Parallel coordinates: no brushes", false, clear_selection},
    {"selection.clear", "escape", "Select nothing", false, clear_selection},
    {"relax.measure", "", "Relaxation: measure the constraint alone", false, measure_constraint_command},
    {"relax.step", "n", "Relaxation: one step", false, step_relaxation},
    {"relax.run", "shift+n", "Relaxation: all steps", false, run_relaxation},
    {"relax.reset", "", "Relaxation: back to the traced photons", false, reset_relaxation},
    {"help.keys", "?", "List every key", false, toggle_keys},
};

constexpr std::pair<std::string_view, ImGuiKey> NAMED_KEYS[] = {
    {"enter", ImGuiKey_Enter},    {"tab", ImGuiKey_Tab},           {"escape", ImGuiKey_Escape},
    {"space", ImGuiKey_Space},    {"up", ImGuiKey_UpArrow},        {"down", ImGuiKey_DownArrow},
    {"left", ImGuiKey_LeftArrow}, {"right", ImGuiKey_RightArrow},  {"home", ImGuiKey_Home},
    {"end", ImGuiKey_End},        {"delete", ImGuiKey_Delete},     {"backspace", ImGuiKey_Backspace},
    {"pageup", ImGuiKey_PageUp},  {"pagedown", ImGuiKey_PageDown}, {"/", ImGuiKey_Slash}};

// "?" is shift and slash on the keyboards ImGui names keys of.
constexpr std::string_view QUESTION = "?";

int parse_key(std::string_view name) {
    if (name.size() == 1 && std::isalpha(static_cast<unsigned char>(name[0])))
        return ImGuiKey_A + (std::tolower(static_cast<unsigned char>(name[0])) - 'a');
    if (name.size() == 1 && std::isdigit(static_cast<unsigned char>(name[0])))
        return ImGuiKey_0 + (name[0] - '0');
    for (const auto& [known, key] : NAMED_KEYS)
        if (name == known)
            return key;
    return ImGuiKey_None;
}

int find_modifier(std::string_view name) {
    return name == "ctrl" ? ImGuiMod_Ctrl : name == "shift" ? ImGuiMod_Shift : name == "alt" ? ImGuiMod_Alt : 0;
}

} // namespace

std::span<const Command> list_commands() {
    return COMMANDS;
}

const Command& find_command(std::string_view name) {
    std::string known;
    for (const Command& command : COMMANDS) {
        if (command.name == name)
            return command;
        known += (known.empty() ? "" : ", ") + std::string(command.name);
    }
    throw Error("there is no command '" + std::string(name) + "'; there are " + known);
}

int parse_chord(std::string_view text) {
    if (text == QUESTION)
        return ImGuiMod_Shift | ImGuiKey_Slash;
    int chord = 0;
    std::string_view rest = text;
    while (true) {
        const std::size_t plus = rest.find('+', 1);
        const std::string_view part = rest.substr(0, plus);
        const int modifier = find_modifier(part);
        if (modifier == 0 || plus == std::string_view::npos) {
            const int key = parse_key(part);
            if ((key == ImGuiKey_None && modifier == 0) || plus != std::string_view::npos)
                throw Error("'" + std::string(text) + "' is not a key; write for example ctrl+enter, tab or 4");
            return chord | key | modifier;
        }
        chord |= modifier;
        rest = rest.substr(plus + 1);
    }
}

void run_pressed_commands(Workspace& workspace) {
    // An open menu takes the keys: escape closes it, and nothing else happens.
    const bool has_menu = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup);
    if (has_menu && ImGui::IsKeyPressed(ImGuiKey_Escape, false))
        ImGui::ClosePopupToLevel(0, true);
    const bool takes_text = ImGui::GetIO().WantTextInput || has_menu;
    // Tab is before and after; ImGui would take it to the next field.
    if (!takes_text)
        ImGui::SetKeyOwner(ImGuiKey_Tab, ImGui::GetID("commands"));
    for (const Command& command : COMMANDS) {
        if (command.keys.empty() || (takes_text && !command.works_in_text))
            continue;
        const int chord = parse_chord(command.keys);
        if (ImGui::IsKeyChordPressed(chord, ImGuiInputFlags_None, ImGuiKeyOwner_Any))
            command.run(workspace);
    }
}

} // namespace photonloupe::studio
