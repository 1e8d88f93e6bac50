// SPDX-License-Identifier: Apache-2.0
// ImGui's widgets with a name each.
#include "studio/widgets.h"

#include <imgui.h>
#include <imgui_internal.h>

namespace photonloupe::studio::ui {

void mark(Workspace& workspace, const std::string& name) {
    // What is scrolled out of sight is not on the screen.
    ImRect seen(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    seen.ClipWith(ImGui::GetCurrentWindowRead()->ClipRect);
    if (seen.GetWidth() > 0 && seen.GetHeight() > 0)
        workspace.widgets[name] = {seen.Min.x, seen.Min.y, seen.GetWidth(), seen.GetHeight()};
}

void explain(const char* text) {
    if (text && ImGui::IsItemHovered(ImGuiHoveredFlags_ForTooltip | ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("%s", text);
}

void beside(const Workspace& workspace, float width) {
    ImGui::SameLine();
    ImGui::SetNextItemWidth(width * workspace.scale);
}

bool button(Workspace& workspace, const std::string& name, const char* label, const char* about) {
    const bool pressed = ImGui::Button(label);
    mark(workspace, name);
    explain(about);
    return pressed;
}

bool toggle(Workspace& workspace, const std::string& name, const char* label, bool& value, const char* about) {
    const bool changed = ImGui::Checkbox(label, &value);
    mark(workspace, name);
    explain(about);
    return changed;
}

bool choose(Workspace& workspace, const std::string& name, const char* label, std::string& value,
            const std::vector<std::string>& entries, const char* about) {
    bool changed = false;
    const bool is_open = ImGui::BeginCombo(label, value.c_str());
    mark(workspace, name);
    explain(about);
    if (!is_open)
        return false;
    const std::string current = value;
    for (const std::string& entry : entries) {
        if (ImGui::Selectable(entry.c_str(), current == entry)) {
            value = entry;
            changed = true;
        }
        mark(workspace, name + "/" + entry);
    }
    ImGui::EndCombo();
    return changed;
}

bool choose_column(Workspace& workspace, const std::string& name, const char* label, std::string& value,
                   const char* extra) {
    bool changed = false;
    const bool is_open = ImGui::BeginCombo(label, value.c_str(), ImGuiComboFlags_HeightLarge);
    mark(workspace, name);
    if (!is_open)
        return false;
    const auto offer = [&](const std::string& entry, const std::string& about, bool is_missing) {
        ImGui::BeginDisabled(is_missing);
        if (ImGui::Selectable(entry.c_str(), entry == value)) {
            value = entry;
            changed = true;
        }
        ImGui::EndDisabled();
        mark(workspace, name + "/" + entry);
        explain(about.c_str());
    };
    if (extra)
        offer(extra, "the colors a script gives", false);
    for (const inspect::ColumnInfo& info : workspace.list_columns())
        offer(info.name, info.missing.empty() ? info.label : info.missing, !info.missing.empty());
    ImGui::EndCombo();
    return changed;
}

bool slide(Workspace& workspace, const std::string& name, const char* label, float& value, float low, float high,
           const char* format, bool is_logarithmic) {
    const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp | (is_logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
    const bool changed = ImGui::SliderFloat(label, &value, low, high, format, flags);
    mark(workspace, name);
    return changed;
}

bool slide(Workspace& workspace, const std::string& name, const char* label, std::uint32_t& value, std::uint32_t low,
           std::uint32_t high, bool is_logarithmic) {
    const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp | (is_logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
    const bool changed = ImGui::SliderScalar(label, ImGuiDataType_U32, &value, &low, &high, "%u", flags);
    mark(workspace, name);
    return changed;
}

void say_empty(const std::string& text) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextDisabled("%s", text.c_str());
    ImGui::PopTextWrapPos();
}

} // namespace photonloupe::studio::ui
