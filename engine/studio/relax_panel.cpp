// SPDX-License-Identifier: Apache-2.0
// Relaxation: all settings, its steps, and how displacement, low frequencies and noise fall with them.
#include <imgui.h>
#include <implot.h>

#include "studio/edit_state.h"
#include "studio/panels.h"
#include "studio/stage_choices.h"
#include "studio/widgets.h"

namespace photonloupe::studio {
namespace {

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
    const RelaxSettings chosen = decide_steps(workspace.state);
    ImGui::TextDisabled("%u of %u steps%s", relax.made, *chosen.steps,
                        relax.made > 0 && relax.used != chosen ? ", with other settings" : "");
}

void draw_settings(Workspace& workspace) {
    RelaxSettings choices = workspace.state.relax.choices;
    RelaxSettings completed = complete_choices(workspace.state, workspace.has_parameters());
    const std::string changed =
        ui::edit_settings(workspace, "Relaxation", list_settings(choices), list_settings(completed));
    if (!changed.empty())
        workspace.change(changed, [&](StudioState& state) { state.relax.choices = choices; });
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
    draw_settings(workspace);
    draw_curves(workspace);
}

} // namespace photonloupe::studio
