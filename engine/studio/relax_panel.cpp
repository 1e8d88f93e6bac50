// SPDX-License-Identifier: Apache-2.0
// Relaxation: all settings, its steps, and how displacement, low frequencies and noise fall with them.
#include <cmath>

#include <imgui.h>
#include <implot.h>

#include "studio/edit_state.h"
#include "studio/panels.h"
#include "studio/widgets.h"

namespace photonloupe::studio {
namespace {

constexpr float LARGEST_THRESHOLD = 1e30f;

template <class Change>
void edit(Workspace& workspace, const char* name, const Change& make) {
    workspace.change(name, [&](StudioState& state) { make(state.relax.choices); });
}

void draw_buttons(Workspace& workspace) {
    if (ui::button(workspace, "Relaxation/Step", "Step", "One step (N)"))
        step_relaxation(workspace);
    ImGui::SameLine();
    if (ui::button(workspace, "Relaxation/Run", "Run", "All steps (Shift-N)"))
        run_relaxation(workspace);
    ImGui::SameLine();
    if (ui::button(workspace, "Relaxation/Measure", "Constraint", "Measure the constraint without moving a photon"))
        measure_constraint_command(workspace);
    ImGui::SameLine();
    if (ui::button(workspace, "Relaxation/Reset", "Reset", "Back to the traced photons"))
        reset_relaxation(workspace);
    ImGui::SameLine();
    const RelaxState& relax = workspace.state.relax;
    ImGui::TextDisabled("%u of %u steps%s", relax.made, relax.choices.steps,
                        relax.made > 0 && relax.used != relax.choices ? ", with other settings" : "");
}

void draw_numbers(Workspace& workspace) {
    const RelaxChoices& now = workspace.state.relax.choices;
    RelaxChoices choices = now;
    const float width = 0.34f * ImGui::GetContentRegionAvail().x;
    ImGui::PushItemWidth(width);
    if (ui::slide(workspace, "Relaxation/Steps", "steps", choices.steps, 1, 100))
        edit(workspace, "steps", [&](RelaxChoices& state) { state.steps = choices.steps; });
    ImGui::SameLine(0.5f * ImGui::GetContentRegionAvail().x);
    if (ui::slide(workspace, "Relaxation/Neighbors", "K", choices.neighbors, 1, 100, true))
        edit(workspace, "neighbors", [&](RelaxChoices& state) { state.neighbors = choices.neighbors; });
    if (ui::slide(workspace, "Relaxation/High", "λmax", choices.over_relaxation[0], 0.1f, 4))
        edit(workspace, "λmax", [&](RelaxChoices& state) { state.over_relaxation = choices.over_relaxation; });
    ImGui::SameLine(0.5f * ImGui::GetContentRegionAvail().x);
    if (ui::slide(workspace, "Relaxation/Low", "λmin", choices.over_relaxation[1], 0.1f, 4))
        edit(workspace, "λmin", [&](RelaxChoices& state) { state.over_relaxation = choices.over_relaxation; });
    if (ui::slide(workspace, "Relaxation/Limit", "ρ", choices.limit, 0, 2, choices.limit > 0 ? "%.2f" : "no limit"))
        edit(workspace, "ρ", [&](RelaxChoices& state) { state.limit = choices.limit; });
    ImGui::SameLine(0.5f * ImGui::GetContentRegionAvail().x);
    if (ui::slide(workspace, "Relaxation/ConstraintNeighbors", "k", choices.constraint_neighbors, 12, 400, true))
        edit(workspace, "constraint k",
             [&](RelaxChoices& state) { state.constraint_neighbors = choices.constraint_neighbors; });
    ImGui::BeginDisabled(now.has_auto_beta);
    if (ui::slide(workspace, "Relaxation/Beta", "β", choices.beta, 0, 30))
        edit(workspace, "β", [&](RelaxChoices& state) { state.beta = choices.beta; });
    ImGui::EndDisabled();
    ImGui::SameLine(0.5f * ImGui::GetContentRegionAvail().x);
    if (ui::toggle(workspace, "Relaxation/AutoBeta", "auto β", now.has_auto_beta, "[SJL15] eq. 6"))
        edit(workspace, "auto β", [](RelaxChoices& state) { state.has_auto_beta = !state.has_auto_beta; });
    ImGui::PopItemWidth();
}

void draw_choices(Workspace& workspace) {
    const RelaxChoices& now = workspace.state.relax.choices;
    ImGui::PushItemWidth(0.28f * ImGui::GetContentRegionAvail().x);
    static constexpr const char* DESCRIPTORS[] = {"none", "gradient", "pca", "tensor", "split"};
    const int descriptor = ui::choose(workspace, "Relaxation/Descriptor", "descriptor", now.descriptor,
                                      {DESCRIPTORS[0], DESCRIPTORS[1], DESCRIPTORS[2], DESCRIPTORS[3], DESCRIPTORS[4]});
    if (descriptor >= 0)
        edit(workspace, "descriptor", [&](RelaxChoices& state) { state.descriptor = DESCRIPTORS[descriptor]; });
    ImGui::SameLine(0.5f * ImGui::GetContentRegionAvail().x);
    const int space = ui::choose(workspace, "Relaxation/Constraint", "constraint", now.constraint,
                                 {"auto", "world", "parameter"}, "Which photons say where one may go");
    if (space >= 0)
        edit(workspace, "constraint", [&](RelaxChoices& state) {
            state.constraint = space == 0 ? "auto" : space == 1 ? "world" : "parameter";
        });
    const int repel = ui::choose(workspace, "Relaxation/Repel", "repel", now.repel, {"world", "parameter"});
    if (repel >= 0)
        edit(workspace, "repulsion", [&](RelaxChoices& state) { state.repel = repel == 0 ? "world" : "parameter"; });
    ImGui::SameLine(0.5f * ImGui::GetContentRegionAvail().x);
    const int search = ui::choose(workspace, "Relaxation/Search", "search", now.search, {"exact", "carried"},
                                  "Radii of every step, or those of the step before, corrected by count");
    if (search >= 0)
        edit(workspace, "search", [&](RelaxChoices& state) { state.search = search == 0 ? "exact" : "carried"; });
    const int surface = ui::choose(workspace, "Relaxation/Surface", "surface", now.surface, {"auto", "tangent"},
                                   "Photons return to the surface they lie on, or move in their tangent planes");
    if (surface >= 0)
        edit(workspace, "surface", [&](RelaxChoices& state) { state.surface = surface == 0 ? "auto" : "tangent"; });
    std::array<float, 2> thresholds = now.thresholds;
    if (ImGui::InputFloat2("thresholds", thresholds.data(), "%.3g"))
        edit(workspace, "thresholds", [&](RelaxChoices& state) {
            for (std::size_t i = 0; i < 2; ++i)
                if (std::abs(thresholds[i]) <= LARGEST_THRESHOLD)
                    state.thresholds[i] = thresholds[i];
        });
    ui::mark(workspace, "Relaxation/Thresholds");
    ui::explain("Value of the descriptor that leaves a photon free, and the one that fixes it; equal: its own");
    ImGui::SameLine(0.5f * ImGui::GetContentRegionAvail().x);
    if (ui::toggle(workspace, "Relaxation/Flux", "even out flux", now.diffuse_flux))
        edit(workspace, "even out flux", [](RelaxChoices& state) { state.diffuse_flux = !state.diffuse_flux; });
    ImGui::PopItemWidth();
}

void draw_curves(Workspace& workspace) {
    const std::vector<StepResult>& steps = workspace.results.steps;
    if (steps.empty()) {
        ui::say_empty("no step has been made; Step makes one, Run all of them");
        return;
    }
    std::vector<double> numbers, displacements, moves, frequencies, noise;
    for (const StepResult& step : steps) {
        numbers.push_back(static_cast<double>(numbers.size() + 1));
        displacements.push_back(step.mean_displacement);
        moves.push_back(step.mean_move);
        frequencies.push_back(step.low_frequency);
        noise.push_back(step.noise);
    }
    if (!ImPlot::BeginPlot("##steps", {-1, -1}, ImPlotFlags_NoMouseText))
        return;
    ImPlot::SetupAxes("step", nullptr, ImPlotAxisFlags_AutoFit, ImPlotAxisFlags_AutoFit);
    ImPlot::SetupAxis(ImAxis_Y2, nullptr, ImPlotAxisFlags_AuxDefault | ImPlotAxisFlags_AutoFit);
    ImPlot::SetupLegend(ImPlotLocation_NorthEast);
    const int count = static_cast<int>(steps.size());
    ImPlot::PlotLine("mean move / r", numbers.data(), moves.data(), count);
    ImPlot::PlotLine("low-frequency power", numbers.data(), frequencies.data(), count);
    ImPlot::PlotLine("estimate noise", numbers.data(), noise.data(), count);
    ImPlot::SetAxes(ImAxis_X1, ImAxis_Y2);
    ImPlot::PlotLine("mean displacement [m]", numbers.data(), displacements.data(), count);
    ImPlot::EndPlot();
    ui::mark(workspace, "Relaxation/Curves");
}

} // namespace

void draw_relax_panel(Workspace& workspace) {
    draw_buttons(workspace);
    draw_numbers(workspace);
    draw_choices(workspace);
    draw_curves(workspace);
}

} // namespace photonloupe::studio
