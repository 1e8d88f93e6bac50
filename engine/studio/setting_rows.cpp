// SPDX-License-Identifier: Apache-2.0
// Draws settings by their kind.
#include "studio/widgets.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include <imgui.h>

namespace photonloupe::studio::ui {
namespace {

// Of the panel's width; what is automatic has a box beside it.
constexpr float WIDTH = 0.28f, WIDTH_BESIDE_BOX = 0.18f;
constexpr int MOST_NUMBERS = 4;

std::string find_label(const Setting& setting) {
    std::string label = setting.about.symbol.empty() ? setting.label() : setting.about.symbol;
    for (char& letter : label)
        if (letter == '_')
            letter = ' ';
    return label;
}

// What a widget of floats gives, without digits that were not meant.
double round_float(float value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", static_cast<double>(value));
    double rounded = 0;
    std::from_chars(text, text + sizeof text, rounded);
    return rounded;
}

bool edit_count(const Setting& setting, const std::string& label, SettingValue& value) {
    const SettingInfo& about = setting.about;
    auto count = static_cast<std::uint64_t>(std::get<double>(value));
    const auto low = static_cast<std::uint64_t>(about.usual.low), high = static_cast<std::uint64_t>(about.usual.high);
    const std::uint64_t step = std::max<std::uint64_t>(1, count / 10);
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp | (about.is_logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
    const bool changed = about.usual.is_given()
                             ? ImGui::SliderScalar(label.c_str(), ImGuiDataType_U64, &count, &low, &high, "%llu", flags)
                             : ImGui::InputScalar(label.c_str(), ImGuiDataType_U64, &count, &step, nullptr, "%llu",
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    value = static_cast<double>(count);
    return changed;
}

bool edit_numbers(const Setting& setting, const std::string& label, std::vector<double>& values) {
    const SettingInfo& about = setting.about;
    const int count = std::min(static_cast<int>(values.size()), MOST_NUMBERS);
    float numbers[MOST_NUMBERS];
    for (int i = 0; i < count; ++i)
        numbers[i] = static_cast<float>(values[i]);
    const auto low = static_cast<float>(about.usual.low), high = static_cast<float>(about.usual.high);
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp | (about.is_logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
    const bool changed =
        about.usual.is_given()
            ? ImGui::SliderScalarN(label.c_str(), ImGuiDataType_Float, numbers, count, &low, &high, "%.3g", flags)
            : ImGui::InputScalarN(label.c_str(), ImGuiDataType_Float, numbers, count, nullptr, nullptr, "%.3g");
    for (int i = 0; i < count; ++i)
        if (numbers[i] != static_cast<float>(values[i]))
            values[i] = round_float(numbers[i]);
    return changed;
}

// The names to choose from, that of holding nothing first.
bool edit_choice(Workspace& workspace, const std::string& name, const Setting& setting, const std::string& label,
                 SettingValue& value) {
    std::vector<std::string> names = setting.about.choices;
    if (!setting.about.empty.empty())
        names.insert(names.begin(), setting.about.empty);
    std::string chosen = write_text(setting);
    const bool changed = choose(workspace, name, label.c_str(), chosen, names, setting.about.doc.c_str());
    if (changed)
        value = chosen;
    return changed;
}

// A value to begin with, where the setting holds nothing.
SettingValue find_shown(const Setting& setting, const Setting& completed) {
    const SettingValue held = completed.read(completed);
    if (!std::holds_alternative<std::monostate>(held))
        return held;
    const double middle = std::floor(std::sqrt(setting.about.range.low * setting.about.range.high));
    if (setting.kind == SettingKind::numbers)
        return std::vector<double>(setting.width, middle);
    return middle;
}

// What may hold nothing: a box that says so, and its value beside it.
bool edit_box(Workspace& workspace, const std::string& name, const Setting& setting, SettingValue& value) {
    bool is_empty = std::holds_alternative<std::monostate>(setting.read(setting));
    ImGui::SameLine();
    const std::string label = setting.about.empty + "##" + name;
    const std::string about = setting.about.automatic.empty() ? setting.about.doc : setting.about.automatic;
    if (!toggle(workspace, name + "/" + setting.about.empty, label.c_str(), is_empty, about.c_str()))
        return false;
    if (is_empty)
        value = {};
    return true;
}

bool edit_setting(Workspace& workspace, const std::string& name, const Setting& setting, const Setting& completed,
                  float width) {
    const std::string label = find_label(setting) + "##" + name;
    SettingValue value = find_shown(setting, completed);
    const bool may_be_empty = !setting.about.empty.empty() && setting.kind != SettingKind::choice;
    const bool is_empty = std::holds_alternative<std::monostate>(setting.read(setting));
    ImGui::SetNextItemWidth((may_be_empty ? WIDTH_BESIDE_BOX : WIDTH) * width);
    ImGui::BeginDisabled(may_be_empty && is_empty);
    bool changed = false;
    if (setting.kind == SettingKind::choice) {
        changed = edit_choice(workspace, name, setting, label, value);
    } else if (setting.kind == SettingKind::flag) {
        changed = toggle(workspace, name, label.c_str(), std::get<bool>(value), setting.about.doc.c_str());
    } else if (setting.kind == SettingKind::count) {
        changed = edit_count(setting, label, value);
    } else {
        const bool is_one = setting.kind == SettingKind::number;
        std::vector<double> numbers =
            is_one ? std::vector<double>{std::get<double>(value)} : std::get<std::vector<double>>(value);
        changed = edit_numbers(setting, label, numbers);
        value = is_one ? SettingValue(numbers.front()) : SettingValue(numbers);
    }
    if (setting.kind != SettingKind::choice) {
        mark(workspace, name);
        explain(setting.about.doc.c_str());
    }
    ImGui::EndDisabled();
    if (may_be_empty && edit_box(workspace, name, setting, value))
        changed = true;
    return changed && try_setting(setting, value).empty();
}

} // namespace

std::string edit_settings(Workspace& workspace, const std::string& panel, const std::vector<Setting>& settings,
                          const std::vector<Setting>& completed) {
    std::string changed;
    const float width = ImGui::GetContentRegionAvail().x;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        if (i % 2 == 1)
            ImGui::SameLine(0.5f * width);
        if (edit_setting(workspace, panel + "/" + settings[i].label(), settings[i], completed[i], width))
            changed = settings[i].label();
    }
    return changed;
}

} // namespace photonloupe::studio::ui
