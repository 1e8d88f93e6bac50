// SPDX-License-Identifier: Apache-2.0
// Opens the windows in their places and lets each panel draw itself.
#include "studio/panels.h"

#include <functional>

#include <imgui.h>
#include <imgui_internal.h>

#include "core/error.h"
#include "studio/histogram_panel.h"
#include "studio/image_panel.h"
#include "studio/parallel_panel.h"
#include "studio/scatter_panel.h"
#include "studio/script_panel.h"
#include "studio/view_panel.h"

namespace photonloupe::studio {
namespace {

constexpr float LEFT_SHARE = 0.23f;       // of the window: the script
constexpr float RIGHT_SHARE = 0.30f;      // of what is left: loupe, relaxation, image
constexpr float PLOT_SHARE = 0.36f;       // of the height: plots under the view
constexpr float NUMBER_SHARE = 0.52f;     // of the height: the lower panels on the right
constexpr std::uint64_t DOCKED_FRAME = 1; // windows stand in their docks after it

// The tab of the current window, by which a panel behind others is brought to the front.
void mark_tab(Workspace& workspace, const char* name) {
    const ImGuiWindow& window = *ImGui::GetCurrentWindow();
    const ImRect& tab = window.DC.DockTabItemRect;
    if (window.DockIsActive)
        workspace.widgets[std::string("Tab/") + name] = {tab.Min.x, tab.Min.y, tab.GetWidth(), tab.GetHeight()};
}

} // namespace

Panels::Panels() = default;
Panels::~Panels() = default;

void require_panel(const std::string& name) {
    std::string known;
    for (const char* panel : PANEL_NAMES) {
        if (name == panel)
            return;
        known += (known.empty() ? "" : ", ") + std::string(panel);
    }
    throw Error("there is no panel '" + name + "'; there are " + known);
}

void Panels::arrange(unsigned dock, float width, float height) {
    ImGui::DockBuilderAddNode(dock, ImGuiDockNodeFlags_DockSpace);
    ImGui::DockBuilderSetNodeSize(dock, {width, height});
    ImGuiID middle = dock;
    const ImGuiID left = ImGui::DockBuilderSplitNode(middle, ImGuiDir_Left, LEFT_SHARE, nullptr, &middle);
    ImGuiID right = ImGui::DockBuilderSplitNode(middle, ImGuiDir_Right, RIGHT_SHARE, nullptr, &middle);
    const ImGuiID plots = ImGui::DockBuilderSplitNode(middle, ImGuiDir_Down, PLOT_SHARE, nullptr, &middle);
    const ImGuiID numbers = ImGui::DockBuilderSplitNode(right, ImGuiDir_Down, NUMBER_SHARE, nullptr, &right);
    for (const auto& [name, node] :
         {std::pair("Script", left), std::pair("View", middle), std::pair("Loupe", right),
          std::pair("Parallel coordinates", plots), std::pair("Relaxation", numbers), std::pair("Image", numbers),
          std::pair("Histogram", numbers), std::pair("Parameter space", plots)})
        ImGui::DockBuilderDockWindow(name, node);
    ImGui::DockBuilderFinish(dock);
}

void Panels::draw(Workspace& workspace) {
    if (!m_script) {
        m_script = std::make_unique<ScriptPanel>(workspace);
        m_view = std::make_unique<ViewPanel>();
        m_parallel = std::make_unique<ParallelPanel>();
        m_scatter = std::make_unique<ScatterPanel>();
        m_histogram = std::make_unique<HistogramPanel>();
        m_image = std::make_unique<ImagePanel>();
    }
    workspace.wants_render = shows_render(workspace.state.view.mode);
    const std::pair<const char*, std::function<void()>> panels[] = {
        {"Script", [&] { m_script->draw(workspace); }},
        {"View", [&] { m_view->draw(workspace); }},
        {"Loupe", [&] { draw_loupe_panel(workspace); }},
        {"Parallel coordinates", [&] { m_parallel->draw(workspace); }},
        {"Parameter space", [&] { m_scatter->draw(workspace); }},
        {"Histogram", [&] { m_histogram->draw(workspace); }},
        {"Relaxation", [&] { draw_relax_panel(workspace); }},
        {"Image", [&] { m_image->draw(workspace); }},
    };
    for (const auto& [name, draw_panel] : panels) {
        ImGuiWindowFlags flags = ImGuiWindowFlags_NoCollapse;
        if (!workspace.solo.empty()) {
            if (workspace.solo != name)
                continue;
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
            flags |= ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoDocking;
        }
        if (workspace.focus == name && workspace.frame > DOCKED_FRAME) {
            ImGui::SetNextWindowFocus();
            workspace.focus.clear();
        }
        const bool is_seen = ImGui::Begin(name, nullptr, flags);
        mark_tab(workspace, name);
        if (is_seen)
            draw_panel();
        ImGui::End();
    }
    if (workspace.solo.empty() || workspace.solo == "Status")
        draw_status_line(workspace);
    draw_key_list(workspace);
}

} // namespace photonloupe::studio
