// SPDX-License-Identifier: Apache-2.0
// Sets ImGui's and ImPlot's colors and measures.
#include "studio/theme.h"

#include <utility>

#include <imgui.h>
#include <implot.h>

namespace photonloupe::studio {
namespace {

constexpr ImVec4 INK{0.88f, 0.89f, 0.90f, 1}, PALE{0.55f, 0.57f, 0.60f, 1};
constexpr ImVec4 GROUND{0.115f, 0.12f, 0.13f, 1}, RAISED{0.19f, 0.20f, 0.215f, 1}, LIFTED{0.26f, 0.275f, 0.30f, 1};
constexpr ImVec4 BLUE{0.31f, 0.55f, 0.82f, 1};

const std::pair<ImGuiCol, ImVec4> COLORS[] = {
    {ImGuiCol_Text, INK},
    {ImGuiCol_TextDisabled, PALE},
    {ImGuiCol_WindowBg, GROUND},
    {ImGuiCol_ChildBg, GROUND},
    {ImGuiCol_PopupBg, {0.14f, 0.145f, 0.155f, 0.98f}},
    {ImGuiCol_Border, {0.28f, 0.29f, 0.31f, 1}},
    {ImGuiCol_FrameBg, RAISED},
    {ImGuiCol_FrameBgHovered, LIFTED},
    {ImGuiCol_FrameBgActive, LIFTED},
    {ImGuiCol_TitleBg, {0.09f, 0.095f, 0.10f, 1}},
    {ImGuiCol_TitleBgActive, {0.09f, 0.095f, 0.10f, 1}},
    {ImGuiCol_Button, LIFTED},
    {ImGuiCol_ButtonHovered, {0.33f, 0.36f, 0.40f, 1}},
    {ImGuiCol_ButtonActive, BLUE},
    {ImGuiCol_Header, LIFTED},
    {ImGuiCol_HeaderHovered, {0.31f, 0.34f, 0.38f, 1}},
    {ImGuiCol_HeaderActive, BLUE},
    {ImGuiCol_SliderGrab, BLUE},
    {ImGuiCol_SliderGrabActive, {0.45f, 0.68f, 0.93f, 1}},
    {ImGuiCol_CheckMark, {0.45f, 0.68f, 0.93f, 1}},
    {ImGuiCol_Tab, {0.13f, 0.135f, 0.145f, 1}},
    {ImGuiCol_TabHovered, {0.31f, 0.34f, 0.38f, 1}},
    {ImGuiCol_TabSelected, RAISED},
    {ImGuiCol_TabSelectedOverline, BLUE},
    {ImGuiCol_TabDimmed, {0.13f, 0.135f, 0.145f, 1}},
    {ImGuiCol_TabDimmedSelected, RAISED},
    {ImGuiCol_TabDimmedSelectedOverline, PALE},
    {ImGuiCol_Separator, {0.24f, 0.25f, 0.27f, 1}},
    {ImGuiCol_ScrollbarBg, GROUND},
    {ImGuiCol_PlotLines, {0.75f, 0.77f, 0.80f, 1}},
    {ImGuiCol_PlotHistogram, BLUE},
};

} // namespace

void apply_theme(float scale) {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    for (const auto& [place, color] : COLORS)
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
