// SPDX-License-Identifier: Apache-2.0
// Sets ImGui's and ImPlot's colors and measures.
#include "studio/theme.h"

#include <utility>
#include <vector>

#include <imgui.h>
#include <implot.h>

namespace photonloupe::studio {
namespace {

constexpr ImVec4 INK{0.88f, 0.89f, 0.90f, 1}, PALE{0.55f, 0.57f, 0.60f, 1};
constexpr ImVec4 GROUND{0.115f, 0.12f, 0.13f, 1}, RAISED{0.19f, 0.20f, 0.215f, 1}, LIFTED{0.26f, 0.275f, 0.30f, 1};
constexpr ImVec4 BLUE{0.31f, 0.55f, 0.82f, 1};

// Where each color stands.
const std::pair<ImVec4, std::vector<ImGuiCol>> COLORS[] = {
    {INK, {ImGuiCol_Text}},
    {PALE, {ImGuiCol_TextDisabled, ImGuiCol_TabDimmedSelectedOverline}},
    {GROUND, {ImGuiCol_WindowBg, ImGuiCol_ChildBg, ImGuiCol_ScrollbarBg}},
    {{0.14f, 0.145f, 0.155f, 0.98f}, {ImGuiCol_PopupBg}},
    {{0.28f, 0.29f, 0.31f, 1}, {ImGuiCol_Border}},
    {RAISED, {ImGuiCol_FrameBg, ImGuiCol_TabSelected, ImGuiCol_TabDimmedSelected}},
    {LIFTED, {ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive, ImGuiCol_Button, ImGuiCol_Header}},
    {{0.09f, 0.095f, 0.10f, 1}, {ImGuiCol_TitleBg, ImGuiCol_TitleBgActive}},
    {{0.33f, 0.36f, 0.40f, 1}, {ImGuiCol_ButtonHovered}},
    {BLUE,
     {ImGuiCol_ButtonActive, ImGuiCol_HeaderActive, ImGuiCol_SliderGrab, ImGuiCol_TabSelectedOverline,
      ImGuiCol_PlotHistogram}},
    {{0.31f, 0.34f, 0.38f, 1}, {ImGuiCol_HeaderHovered, ImGuiCol_TabHovered}},
    {{0.45f, 0.68f, 0.93f, 1}, {ImGuiCol_SliderGrabActive, ImGuiCol_CheckMark}},
    {{0.13f, 0.135f, 0.145f, 1}, {ImGuiCol_Tab, ImGuiCol_TabDimmed}},
    {{0.24f, 0.25f, 0.27f, 1}, {ImGuiCol_Separator}},
    {{0.75f, 0.77f, 0.80f, 1}, {ImGuiCol_PlotLines}},
};

} // namespace

void apply_theme(float scale) {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    for (const auto& [color, places] : COLORS)
        for (const ImGuiCol place : places)
            style.Colors[place] = color;
    style.WindowPadding = {8, 6};
    style.FramePadding = {6, 3};
    style.ItemSpacing = {6, 4};
    style.FrameRounding = 3;
    style.GrabRounding = 3;
    style.TabRounding = 3;
    style.WindowBorderSize = 0;
    style.ScrollbarSize = 12;
    style.ScaleAllSizes(scale);
    ImPlot::StyleColorsDark();
    ImPlotStyle& plots = ImPlot::GetStyle();
    plots.Colors[ImPlotCol_FrameBg] = GROUND;
    plots.Colors[ImPlotCol_PlotBg] = {0.085f, 0.09f, 0.095f, 1};
    plots.PlotPadding = {6 * scale, 6 * scale};
}

} // namespace photonloupe::studio
