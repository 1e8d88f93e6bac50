// SPDX-License-Identifier: Apache-2.0
// Counts by engine/inspect and plots with ImPlot.
#include "studio/histogram_panel.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>
#include <implot.h>

#include "core/error.h"
#include "studio/widgets.h"

namespace photonloupe::studio {
namespace {

constexpr const char* SCRIPT_PREFIX = "script: ";

inspect::ColumnHistogram take_script(const HistogramResult& result) {
    inspect::ColumnHistogram counted;
    const std::size_t bins = result.counts.size();
    double sum = 0, total = 0;
    for (const double count : result.counts)
        total += count;
    for (std::size_t i = 0; i <= bins; ++i)
        counted.edges.push_back(result.low +
                                (result.high - result.low) * static_cast<double>(i) / static_cast<double>(bins));
    for (const double count : result.counts) {
        counted.counts.push_back(static_cast<std::uint64_t>(count));
        sum += count;
        counted.cdf.push_back(total > 0 ? sum / total : 0);
    }
    return counted;
}

// Where the line stands: while nobody moved it, that of isotropy at t_β.
float find_threshold(const Workspace& workspace) {
    const HistogramState& histogram = workspace.state.histogram;
    const std::optional<IsotropyResult>& isotropy = workspace.results.isotropy;
    const bool is_moved = histogram.threshold != 0 || histogram.column != "isotropy" || !isotropy;
    return is_moved ? histogram.threshold : static_cast<float>(isotropy->threshold);
}

} // namespace

void HistogramPanel::update(Workspace& workspace) {
    const HistogramState& histogram = workspace.state.histogram;
    const std::string key = write_values(histogram.column, histogram.bins, workspace.results.photons_version,
                                         workspace.state.view.shows_relaxed);
    if (key == m_key)
        return;
    m_key = key;
    m_missing.clear();
    m_values.clear();
    if (histogram.column.starts_with(SCRIPT_PREFIX)) {
        const std::string name = histogram.column.substr(std::string(SCRIPT_PREFIX).size());
        m_missing = "the last script run counted no histogram '" + name + "'";
        if (workspace.results.script)
            for (const HistogramResult& result : workspace.results.script->histograms)
                if (result.name == name) {
                    m_counted = take_script(result);
                    m_label = name;
                    m_missing.clear();
                }
        return;
    }
    const inspect::Column* column = workspace.seek_column(histogram.column, &m_missing);
    if (!column)
        return;
    try {
        m_counted = inspect::count_column(*column, histogram.bins);
        m_label = column->label;
        m_values = column->values;
    } catch (const Error& error) {
        m_missing = error.what();
    }
}

// The selected photons in the same bins.
void HistogramPanel::count_selected(const Workspace& workspace) {
    if (m_selected_version == workspace.selection_version && m_selected_key == m_key)
        return;
    m_selected_version = workspace.selection_version;
    m_selected_key = m_key;
    m_selected.clear();
    if (!workspace.state.selection || m_values.empty())
        return;
    inspect::Column chosen;
    for (const std::uint32_t id : *workspace.state.selection)
        if (id < m_values.size())
            chosen.values.push_back(m_values[id]);
    const inspect::ColumnHistogram counted =
        inspect::count_column(chosen, static_cast<std::uint32_t>(m_counted.counts.size()),
                              std::pair(m_counted.edges.front(), m_counted.edges.back()));
    m_selected.assign(counted.counts.begin(), counted.counts.end());
}

void HistogramPanel::draw_toolbar(Workspace& workspace) {
    HistogramState histogram = workspace.state.histogram;
    const auto edit = [&](const char* name) {
        workspace.change(name, [&](StudioState& state) { state.histogram = histogram; });
    };
    ImGui::SetNextItemWidth(140 * workspace.scale);
    if (ui::choose_column(workspace, "Histogram/Column", "##column", histogram.column))
        edit("histogram");
    if (workspace.results.script)
        for (const HistogramResult& result : workspace.results.script->histograms) {
            ImGui::SameLine();
            if (ui::button(workspace, "Histogram/" + result.name, result.name.c_str(), "Counted by the script")) {
                histogram.column = SCRIPT_PREFIX + result.name;
                edit("histogram");
            }
        }
    ui::beside(workspace, 80);
    if (ui::slide(workspace, "Histogram/Bins", "bins", histogram.bins, 4, 512, true))
        edit("bins");
    ImGui::SameLine();
    if (ui::toggle(workspace, "Histogram/Cdf", "share below", histogram.shows_cdf))
        edit("share below");
}

void HistogramPanel::draw_plot(Workspace& workspace) {
    const HistogramState& histogram = workspace.state.histogram;
    std::vector<double> middles, counts;
    for (std::size_t i = 0; i < m_counted.counts.size(); ++i) {
        middles.push_back(0.5 * (m_counted.edges[i] + m_counted.edges[i + 1]));
        counts.push_back(static_cast<double>(m_counted.counts[i]));
    }
    const double width = m_counted.edges.size() > 1 ? m_counted.edges[1] - m_counted.edges[0] : 1;
    if (!ImPlot::BeginPlot("##histogram", {-1, -ImGui::GetTextLineHeightWithSpacing() * 2},
                           ImPlotFlags_NoLegend | ImPlotFlags_NoMouseText))
        return;
    ImPlot::SetupAxes(m_label.c_str(), "photons", 0, 0);
    ImPlot::SetupAxisLimits(ImAxis_X1, m_counted.edges.front(), m_counted.edges.back(), ImPlotCond_Always);
    ImPlot::SetupAxisLimits(ImAxis_Y1, 0, 1.05 * std::max(1.0, *std::max_element(counts.begin(), counts.end())),
                            ImPlotCond_Always);
    if (histogram.shows_cdf) {
        ImPlot::SetupAxis(ImAxis_Y2, "share below", ImPlotAxisFlags_AuxDefault);
        ImPlot::SetupAxisLimits(ImAxis_Y2, 0, 1.05, ImPlotCond_Always);
    }
    ImPlot::PlotBars("counts", middles.data(), counts.data(), static_cast<int>(counts.size()), width);
    if (!m_selected.empty())
        ImPlot::PlotBars("selected", middles.data(), m_selected.data(), static_cast<int>(m_selected.size()), width,
                         {ImPlotProp_FillColor, ImVec4(0.55f, 0.80f, 1.0f, 1)});
    if (histogram.shows_cdf) {
        ImPlot::SetAxes(ImAxis_X1, ImAxis_Y2);
        ImPlot::PlotLine("share", m_counted.edges.data() + 1, m_counted.cdf.data(),
                         static_cast<int>(m_counted.cdf.size()));
        ImPlot::SetAxes(ImAxis_X1, ImAxis_Y1);
    }
    double threshold =
        std::clamp(static_cast<double>(find_threshold(workspace)), m_counted.edges.front(), m_counted.edges.back());
    if (ImPlot::DragLineX(0, &threshold, {1.0f, 0.69f, 0.25f, 1}, 2))
        workspace.change("threshold",
                         [&](StudioState& state) { state.histogram.threshold = static_cast<float>(threshold); });
    const ImVec2 line = ImPlot::PlotToPixels(threshold, 0.5 * ImPlot::GetPlotLimits().Y.Max);
    workspace.widgets["Histogram/Threshold"] = {line.x - 2, line.y - 2, 4, 4};
    ImPlot::EndPlot();
    ui::mark(workspace, "Histogram/Plot");
}

void HistogramPanel::draw(Workspace& workspace) {
    draw_toolbar(workspace);
    update(workspace);
    if (!m_missing.empty() || m_counted.counts.empty()) {
        ui::say_empty(m_missing.empty() ? "there is nothing to count yet" : m_missing);
        return;
    }
    count_selected(workspace);
    draw_plot(workspace);
    const float threshold = find_threshold(workspace);
    if (!m_values.empty()) {
        const double share = inspect::find_share_above(m_values, threshold);
        ImGui::TextDisabled("above %.4g: %.2f %% of the photons; 5 %% lie below %.4g", static_cast<double>(threshold),
                            100 * share, inspect::find_quantile(m_values, 0.05));
        // [SJL15] eq. 6: the axis ratio that all but a share of the photons exceed gives β.
        if (workspace.state.histogram.column == "isotropy" && threshold > 0)
            ImGui::TextDisabled("t_β = %.4g gives β = √(1/t_β) = %.4g", static_cast<double>(threshold),
                                std::sqrt(1.0 / static_cast<double>(threshold)));
    }
}

} // namespace photonloupe::studio
