// SPDX-License-Identifier: Apache-2.0
// Lays out the shared menus; files are asked for as requests.
#include "studio/menus.h"

#include <imgui.h>
#include <imgui_stdlib.h>
#include <nlohmann/json.hpp>

#include "studio/edit_state.h"
#include "studio/panels.h"
#include "studio/widgets.h"

namespace photonloupe::studio {
namespace {

constexpr std::size_t LONGEST_SELECTION_NAME = 64;

void name_selection(Workspace& workspace) {
    ExportMenu& fields = workspace.menus;
    ImGui::BeginDisabled(!workspace.state.selection);
    ImGui::SetNextItemWidth(140 * workspace.scale);
    ImGui::InputTextWithHint("##name", "name", &fields.selection_name);
    ui::mark(workspace, "Selection/Name");
    ImGui::SameLine();
    const bool is_usable = !fields.selection_name.empty() && fields.selection_name.size() <= LONGEST_SELECTION_NAME;
    ImGui::BeginDisabled(!is_usable);
    if (ui::button(workspace, "Selection/Keep", "Keep", "Keep the selection under this name"))
        workspace.change("name selection",
                         [&](StudioState& state) { state.named[fields.selection_name] = state.selection; });
    ImGui::EndDisabled();
    ImGui::EndDisabled();
}

} // namespace

void draw_selection_menu(Workspace& workspace) {
    if (ui::button(workspace, "Selection/Menu", "Selection", "Name, choose or clear the selection"))
        ImGui::OpenPopup("selection");
    if (!ImGui::BeginPopup("selection"))
        return;
    ImGui::TextDisabled("%zu photons selected", workspace.state.selection ? workspace.state.selection->size() : 0);
    name_selection(workspace);
    const std::map<std::string, Ids> named = workspace.state.named;
    for (const auto& [name, ids] : named) {
        const std::string label = name + " (" + std::to_string(ids ? ids->size() : 0) + ")";
        if (ImGui::Selectable(label.c_str(), ids == workspace.state.selection))
            select_instead(workspace, "choose selection", ids);
        ui::mark(workspace, "Selection/" + name);
    }
    if (ui::button(workspace, "Selection/Clear", "Clear", "Select nothing (Escape)"))
        clear_selection(workspace);
    ImGui::EndPopup();
}

void draw_export_menu(Workspace& workspace) {
    if (ui::button(workspace, "Export/Menu", "Export", "Write a panel as a picture, or copy the state as Python"))
        ImGui::OpenPopup("export");
    if (!ImGui::BeginPopup("export"))
        return;
    ExportMenu& fields = workspace.menus;
    ImGui::PushItemWidth(200 * workspace.scale);
    if (ImGui::BeginCombo("panel", fields.panel.c_str())) {
        for (const char* name : PANEL_NAMES)
            if (ImGui::Selectable(name, fields.panel == name))
                fields.panel = name;
        ImGui::EndCombo();
    }
    ui::mark(workspace, "Export/Panel");
    ImGui::InputInt2("pixels", fields.size.data());
    ui::mark(workspace, "Export/Size");
    ImGui::SliderFloat("scale", &fields.scale, 0.5f, 4.0f, "%.2f");
    ui::mark(workspace, "Export/Scale");
    ImGui::InputTextWithHint("file", "figure.png, or .svg of parallel coordinates", &fields.path);
    ui::mark(workspace, "Export/Path");
    ImGui::PopItemWidth();
    if (ui::button(workspace, "Export/Write", "Write")) {
        nlohmann::json asked;
        asked["panel"] = fields.panel;
        asked["size"] = fields.size;
        asked["scale"] = fields.scale;
        asked["path"] = fields.path;
        workspace.requests.push_back("export " + asked.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    }
    ImGui::Separator();
    if (ui::button(workspace, "Export/Python", "Copy as Python", "Ctrl-Shift-C"))
        copy_python(workspace);
    ImGui::SameLine();
    if (ui::button(workspace, "Export/Session", "Save session", "Ctrl-S"))
        save_session_command(workspace);
    ImGui::EndPopup();
}

void draw_restore_offer(Workspace& workspace) {
    if (workspace.restorable.empty())
        return;
    ImGui::SameLine();
    ImGui::TextUnformatted("the program ended unexpectedly:");
    ImGui::SameLine();
    if (ui::button(workspace, "Status/Restore", "Restore its session")) {
        workspace.requests.push_back("restore " + workspace.restorable);
        workspace.restorable.clear();
        return;
    }
    ImGui::SameLine();
    if (ui::button(workspace, "Status/Discard", "Discard")) {
        workspace.requests.push_back("discard " + workspace.restorable);
        workspace.restorable.clear();
    }
}

} // namespace photonloupe::studio
