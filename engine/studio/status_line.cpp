// SPDX-License-Identifier: Apache-2.0
// The line at the bottom: device, photons, columns and their memory, milliseconds, progress with cancel; and the list
// of keys.
#include <algorithm>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "studio/commands.h"
#include "studio/edit_state.h"
#include "studio/menus.h"
#include "studio/panels.h"
#include "studio/theme.h"
#include "studio/widgets.h"

namespace photonloupe::studio {
namespace {

// The columns on the device, and what they take.
std::string list_held(const PhotonMap& map) {
    std::string text;
    const auto add = [&](const char* name, std::initializer_list<const gpu::Buffer*> buffers) {
        std::uint64_t bytes = 0;
        for (const gpu::Buffer* buffer : buffers)
            bytes += buffer->size_bytes();
        char size[32];
        std::snprintf(size, sizeof size, " %.1f MiB", static_cast<double>(bytes) / 1048576.0);
        text += (text.empty() ? "" : ", ") + std::string(name) + size;
    };
    add("photons", {&map.position_emitter, &map.normal_index, &map.power_object});
    if (map.paths)
        add("paths", {&map.paths->starts, &map.paths->vertices, &map.paths->normals});
    if (map.parameters)
        add("parameters", {&map.parameters->values});
    if (map.colors)
        add("colors", {&*map.colors});
    return text;
}

void draw_trace_menu(Workspace& workspace) {
    if (ui::button(workspace, "Trace/Menu", "Photons", "How many photons are traced, and how"))
        ImGui::OpenPopup("trace");
    if (!ImGui::BeginPopup("trace"))
        return;
    TraceSettings settings = workspace.state.trace;
    const std::vector<Setting> rows = list_settings(settings);
    ImGui::Dummy({480 * workspace.scale, 0}); // two columns
    if (const std::string changed = ui::edit_settings(workspace, "Trace", rows, rows); !changed.empty())
        workspace.change(changed, [&](StudioState& state) { static_cast<TraceSettings&>(state.trace) = settings; });
    ImGui::EndPopup();
}

void draw_activity(Workspace& workspace) {
    const Activity& activity = workspace.activity;
    if (activity.is_running) {
        ui::beside(workspace, 160);
        ImGui::ProgressBar(static_cast<float>(activity.fraction), {160 * workspace.scale, 0}, activity.stage.c_str());
        ImGui::SameLine();
        ImGui::BeginDisabled(activity.is_stopping);
        if (ui::button(workspace, "Status/Cancel", activity.is_stopping ? "stopping" : "Cancel"))
            workspace.requests.push_back("cancel");
        ImGui::EndDisabled();
    }
    if (workspace.failed.contains("trace") && !activity.is_running) {
        ImGui::SameLine();
        if (ui::button(workspace, "Status/Add light", "Add a light", "One that suits the scene"))
            add_key_light(workspace);
        ImGui::SameLine();
        if (ui::button(workspace, "Status/Add floor", "Add a floor", "A diffuse square below the scene"))
            add_floor(workspace);
    }
    if (!workspace.failed.empty() && !activity.is_running) {
        ImGui::SameLine();
        if (ui::button(workspace, "Status/Retry", "Retry", "Do again what went wrong")) {
            for (const auto& [kind, error] : workspace.failed)
                workspace.done.erase(kind);
            workspace.failed.clear();
            workspace.say("");
        }
    }
    if (workspace.message.empty())
        return;
    ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_Text, workspace.message_is_error ? WARNING_COLOR : DIM_COLOR);
    const std::string line = workspace.message.substr(0, workspace.message.find('\n'));
    ImGui::TextUnformatted(line.c_str());
    ImGui::PopStyleColor();
    ui::mark(workspace, "Status/Message");
    ui::explain(workspace.message.c_str());
}

} // namespace

void draw_status_line(Workspace& workspace) {
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    const float height = ImGui::GetFrameHeight() + 4 * workspace.scale;
    ImGui::SetNextWindowPos({viewport->Pos.x, viewport->Pos.y + viewport->Size.y - height});
    ImGui::SetNextWindowSize({viewport->Size.x, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8 * workspace.scale, 2 * workspace.scale});
    ImGui::Begin("Status", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoDocking |
                     ImGuiWindowFlags_NoSavedSettings);
    ImGui::PopStyleVar();
    if (ui::button(workspace, "Status/Keys", "?", "List every key"))
        find_command("help.keys").run(workspace);
    ImGui::SameLine();
    draw_export_menu(workspace);
    ImGui::SameLine();
    draw_trace_menu(workspace);
    ui::beside(workspace, 150);
    if (ImGui::InputTextWithHint("##open", "open a scene, map, session", &workspace.open_path,
                                 ImGuiInputTextFlags_EnterReturnsTrue))
        workspace.requests.push_back("open " + workspace.open_path);
    ui::mark(workspace, "Status/Open");
    // What may have to be acted on stands first: a narrow window cuts the rest.
    draw_restore_offer(workspace);
    draw_activity(workspace);
    ImGui::SameLine();
    std::string told = workspace.device.info().name.substr(0, workspace.device.info().name.find(" ("));
    if (const Photons* photons = workspace.shown())
        told += "  |  " + std::to_string(photons->map.count) + " photons: " + list_held(photons->map);
    if (!workspace.is_offscreen)
        told += "  |  " + std::to_string(workspace.device.allocated_bytes() >> 20) + " MiB  |  frame " +
                std::to_string(static_cast<int>(workspace.frame_milliseconds)) + " ms";
    else
        told += "  |  frame – ms";
    if (!workspace.is_offscreen)
        for (const auto& [stage, milliseconds] : workspace.stage_milliseconds)
            told += "  " + stage + " " + std::to_string(static_cast<int>(milliseconds)) + " ms";
    ImGui::TextDisabled("%s", told.c_str());
    ImGui::End();
}

void draw_key_list(Workspace& workspace) {
    if (!workspace.shows_keys)
        return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * size.x, 0.5f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({0, std::min(0.9f * size.y, 720 * workspace.scale)});
    if (workspace.focus == "Keys") {
        ImGui::SetNextWindowFocus();
        workspace.focus.clear();
    }
    if (ImGui::Begin("Keys", &workspace.shows_keys, ImGuiWindowFlags_NoDocking | ImGuiWindowFlags_NoCollapse)) {
        if (ImGui::BeginTable("##keys", 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit)) {
            const auto row = [](const std::string& keys, const std::string& about) {
                ImGui::TableNextRow();
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(keys.c_str());
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(about.c_str());
            };
            for (const Command& command : list_commands())
                if (!command.keys.empty())
                    row(std::string(command.keys), std::string(command.about));
            row("wheel", "View: photons in the loupe");
            row("ctrl+wheel", "View: nearer or farther");
            row("drag", "View: orbit; with the right or middle button: pan");
            row("click", "View: pin the photon");
            row("drag on an axis", "Parallel coordinates: brush; with Ctrl one more, with Shift zoom, with Alt move");
            row("right click on an axis", "Parallel coordinates: closed, periods, flipped, whole range, remove");
            row("drag", "Parameter space: lasso");
            ImGui::EndTable();
        }
    }
    const ImVec2 low = ImGui::GetWindowPos(), extent = ImGui::GetWindowSize();
    workspace.widgets["Keys"] = {low.x, low.y, extent.x, extent.y};
    ImGui::End();
}

} // namespace photonloupe::studio
