// SPDX-License-Identifier: Apache-2.0
// The loupe's choices, and the numbers of the photon at its center, beside those of the pins.
#include <algorithm>
#include <cmath>
#include <functional>

#include <imgui.h>

#include "studio/edit_state.h"
#include "studio/panels.h"
#include "studio/widgets.h"

namespace photonloupe::studio {
namespace {

constexpr std::size_t MOST_COLUMNS = 8; // of pins beside the cursor's

struct NumberRow {
    std::string group; // as LoupeState::numbers names it
    std::string label;
    std::function<std::string(const inspect::LoupeView&)> write;
};

std::string format(double value) {
    if (std::isnan(value))
        return "–";
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

const NumberRow ROWS[] = {
    {"position", "x [m]", [](const auto& view) { return format(view.numbers.position[0]); }},
    {"position", "y [m]", [](const auto& view) { return format(view.numbers.position[1]); }},
    {"position", "z [m]", [](const auto& view) { return format(view.numbers.position[2]); }},
    {"flux", "flux, red [W]", [](const auto& view) { return format(view.numbers.power.r); }},
    {"flux", "flux, green [W]", [](const auto& view) { return format(view.numbers.power.g); }},
    {"flux", "flux, blue [W]", [](const auto& view) { return format(view.numbers.power.b); }},
    {"signature", "signature",
     [](const auto& view) {
         return view.numbers.interactions.empty() ? std::string("–")
                                                  : view.numbers.interactions + " = " + format(view.numbers.signature);
     }},
    {"tortuosity", "tortuosity", [](const auto& view) { return format(view.numbers.tortuosity); }},
    {"path length", "path length [m]", [](const auto& view) { return format(view.numbers.path_length); }},
    {"eigenvalues", "λ1 [m²]", [](const auto& view) { return format(view.spread.along_variance); }},
    {"eigenvalues", "λ2 [m²]", [](const auto& view) { return format(view.spread.across_variance); }},
    {"isotropy", "isotropy t", [](const auto& view) { return format(view.spread.isotropy); }},
    {"eigenvector 2", "eigenvector 2, x", [](const auto& view) { return format(view.across.x); }},
    {"eigenvector 2", "eigenvector 2, y", [](const auto& view) { return format(view.across.y); }},
    {"eigenvector 2", "eigenvector 2, z", [](const auto& view) { return format(view.across.z); }},
    {"w_v", "w_v", [](const auto& view) { return view.has_constraint ? format(1 - view.freedom_across) : "–"; }},
    {"w_v", "w_u", [](const auto& view) { return view.has_constraint ? format(1 - view.freedom_along) : "–"; }},
    {"one-sidedness", "one-sidedness", [](const auto& view) { return format(view.numbers.one_sidedness); }},
    {"drift", "drift [m]", [](const auto& view) { return format(view.numbers.drift); }},
    {"drift", "pressure |f'|/r", [](const auto& view) { return format(view.numbers.pressure); }},
    {"radius", "radius [m]", [](const auto& view) { return format(view.radius); }},
};

constexpr const char* GROUPS[] = {"position",      "parameters",  "flux",     "signature",     "tortuosity",
                                  "path length",   "eigenvalues", "isotropy", "eigenvector 2", "w_v",
                                  "one-sidedness", "drift",       "radius"};

void draw_choices(Workspace& workspace) {
    LoupeState loupe = workspace.state.loupe;
    const auto edit = [&](const std::string& name) {
        change_loupe(workspace, name, [&](LoupeState& state) { state = loupe; });
    };
    const std::vector<Setting> settings = list_settings<inspect::LoupeSettings>(loupe);
    if (const std::string changed = ui::edit_settings(workspace, "Loupe", settings, settings); !changed.empty())
        edit("loupe " + changed);
    ImGui::SameLine(0.5f * ImGui::GetContentRegionAvail().x);
    ImGui::BeginDisabled(loupe.space != SearchSpace::constrained);
    ImGui::SetNextItemWidth(0.34f * ImGui::GetContentRegionAvail().x);
    if (ui::choose(workspace, "Loupe/Lock", "range", loupe.lock, {"none", "pin", "brushes"},
                   "What the parameter range keeps to while the cursor moves: the photon under it, the last pin, or "
                   "the brushed intervals"))
        edit("lock range");
    ImGui::EndDisabled();
    if (ui::button(workspace, "Loupe/Pin", "Pin", "Keep the photon at the center (P, or click)"))
        pin_photon(workspace);
    ImGui::SameLine();
    if (ui::button(workspace, "Loupe/Unpin", "Unpin", "Let go of all pins (Shift-P)"))
        unpin_photons(workspace);
    ImGui::SameLine();
    if (ui::toggle(workspace, "Loupe/Paths", "paths", loupe.shows_paths, "Light paths of the nearest (T)"))
        toggle_paths(workspace);
    ImGui::SameLine();
    if (ui::toggle(workspace, "Loupe/Drift", "drift", loupe.shows_drift, "Ellipses of how far each photon moved"))
        edit("drift");
    ImGui::SameLine();
    if (ui::button(workspace, "Loupe/Numbers", "Numbers"))
        ImGui::OpenPopup("numbers");
    if (ImGui::BeginPopup("numbers")) {
        for (const char* group : GROUPS) {
            bool is_on = std::find(loupe.numbers.begin(), loupe.numbers.end(), group) != loupe.numbers.end();
            if (ui::toggle(workspace, std::string("Loupe/Numbers/") + group, group, is_on)) {
                if (is_on)
                    loupe.numbers.push_back(group);
                else
                    std::erase(loupe.numbers, group);
                edit("numbers");
            }
        }
        ImGui::EndPopup();
    }
}

using Shown = std::vector<std::pair<std::string, const inspect::LoupeView*>>;

void draw_row(const std::string& label, const Shown& shown,
              const std::function<std::string(const inspect::LoupeView&)>& write) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", label.c_str());
    for (const auto& [name, view] : shown) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(write(*view).c_str());
    }
}

void draw_parameters(const Shown& shown) {
    const auto& parameters = shown.front().second->numbers.parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i)
        draw_row(parameters[i].first, shown, [i](const inspect::LoupeView& view) {
            return i < view.numbers.parameters.size() ? format(view.numbers.parameters[i].second) : std::string("–");
        });
}

void draw_numbers(Workspace& workspace) {
    Shown shown;
    if (workspace.loupe && workspace.loupe->center)
        shown.emplace_back("#" + std::to_string(*workspace.loupe->center), &*workspace.loupe);
    for (const auto& [pin, view] : workspace.pinned)
        if (shown.size() <= MOST_COLUMNS)
            shown.emplace_back("pin #" + std::to_string(pin), &view);
    if (shown.empty()) {
        ui::say_empty(!workspace.loupe_missing.empty() ? workspace.loupe_missing
                                                       : "move the cursor over the photons in the view");
        return;
    }
    const inspect::LoupeView& first = *shown.front().second;
    LoupeState state = workspace.state.loupe;
    ui::say_empty(std::to_string(first.ids.size()) + " photons within " + format(first.radius) + " m, " +
                  write_text(find_setting(list_settings<inspect::LoupeSettings>(state), "space")) + "; basis of " +
                  (first.has_constraint ? "the constraint" : "the photons found"));
    if (!ImGui::BeginTable("##numbers", static_cast<int>(shown.size()) + 1,
                           ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_ScrollY))
        return;
    ImGui::TableSetupColumn("");
    for (const auto& [name, view] : shown)
        ImGui::TableSetupColumn(name.c_str());
    ImGui::TableHeadersRow();
    const std::vector<std::string>& chosen = workspace.state.loupe.numbers;
    const auto is_chosen = [&](const std::string& group) {
        return std::find(chosen.begin(), chosen.end(), group) != chosen.end();
    };
    if (is_chosen("parameters"))
        draw_parameters(shown);
    for (const NumberRow& row : ROWS)
        if (is_chosen(row.group))
            draw_row(row.label, shown, row.write);
    ImGui::EndTable();
    ui::mark(workspace, "Loupe/Table");
}

} // namespace

void draw_loupe_panel(Workspace& workspace) {
    draw_choices(workspace);
    ImGui::Separator();
    if (!workspace.loupe_missing.empty() && workspace.loupe)
        ui::say_empty(workspace.loupe_missing);
    draw_numbers(workspace);
}

} // namespace photonloupe::studio
