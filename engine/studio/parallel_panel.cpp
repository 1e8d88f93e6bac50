// SPDX-License-Identifier: Apache-2.0
// Makes the plot by engine/inspect and draws axes, densities and brushes over it.
#include "studio/parallel_panel.h"

#include <algorithm>
#include <chrono>

#include <imgui.h>

#include "core/error.h"
#include "studio/edit_axes.h"
#include "studio/edit_state.h"
#include "studio/menus.h"
#include "studio/theme.h"
#include "studio/widgets.h"

namespace photonloupe::studio {
namespace {

constexpr std::size_t MOST_AXES = 32; // as sessions hold
constexpr ImU32 AXIS_COLOR = 0xffc8c8c8, DENSITY_COLOR = 0x70a0a0a0, BRUSH_COLOR = 0xa040b0ff;
constexpr float DENSITY_WIDTH = 22;

std::string write_key(const Workspace& workspace, std::uint32_t width, std::uint32_t height) {
    const ParallelState& parallel = workspace.state.parallel;
    std::string key = write_values(width, height, workspace.results.photons_version, parallel.source, parallel.color,
                                   parallel.tension, workspace.state.view.shows_relaxed, workspace.selection_version,
                                   parallel.source == "loupe" ? workspace.loupe_result_version : 0);
    for (const AxisState& axis : parallel.axes) {
        key += write_values(axis.name, axis.low, axis.high, axis.is_flipped, axis.is_closed, axis.periods);
        for (const auto& [low, high] : axis.brushes)
            key += write_values(low, high);
    }
    return key;
}

glm::vec3 unpack_color(std::uint32_t packed) {
    return glm::vec3(packed & 255, packed >> 8 & 255, packed >> 16 & 255) / 255.0f;
}

std::string format(float value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", static_cast<double>(value));
    return text;
}

// The area between the axis and its density, a strip between two samples at a time.
void fill_density(const inspect::Axis& axis, const inspect::AxisPlace& stand, const inspect::AxisDensity& density,
                  ImVec2 corner) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImDrawFlags flags = std::exchange(list.Flags, list.Flags & ~ImDrawFlags_AAFill);
    const auto place = [&](std::size_t sample, float depth) {
        const glm::vec2 point = inspect::find_point(axis, stand, density.shares[sample]);
        const glm::vec2 away = point + depth * inspect::find_outward(stand, point);
        return ImVec2(corner.x + away.x, corner.y + away.y);
    };
    for (std::size_t i = 0; i + 1 < density.shares.size(); ++i)
        list.AddQuadFilled(place(i, 0), place(i, DENSITY_WIDTH * density.heights[i]),
                           place(i + 1, DENSITY_WIDTH * density.heights[i + 1]), place(i + 1, 0), DENSITY_COLOR);
    list.Flags = flags;
}

} // namespace

void ParallelPanel::find_axes(Workspace& workspace) {
    m_plot.names.clear();
    m_plot.places.clear();
    m_plot.columns.clear();
    m_plot.axes.clear();
    const std::vector<AxisState> axes = list_axes(workspace);
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const inspect::Column* column = workspace.seek_column(axes[i].name);
        if (!column)
            continue; // a parameter of another script: the axis waits for it
        m_plot.columns.push_back(*column);
        m_plot.names.push_back(axes[i].name);
        m_plot.places.push_back(i);
        m_plot.axes.push_back(make_plot_axis(axes[i], m_plot.columns, m_plot.columns.size() - 1));
    }
}

void ParallelPanel::draw_curves(Workspace& workspace, const inspect::Selection& photons) {
    const ParallelState& parallel = workspace.state.parallel;
    const Ids& chosen = workspace.state.selection;
    inspect::Selection selected, context;
    for (const std::uint32_t id : photons)
        (!chosen || std::binary_search(chosen->begin(), chosen->end(), id) ? selected : context).push_back(id);
    const std::vector<std::uint32_t>& packed = workspace.find_colors(parallel.color);
    std::vector<glm::vec3> colors;
    if (!packed.empty())
        for (const std::uint32_t id : selected)
            colors.push_back(unpack_color(packed[id]));
    const inspect::Curves below =
        inspect::build_curves(m_plot.columns, m_plot.axes, m_plot.layout, context, parallel.tension);
    const inspect::Curves above =
        inspect::build_curves(m_plot.columns, m_plot.axes, m_plot.layout, selected, parallel.tension);
    inspect::CurveStyle style;
    style.background = {0.085f, 0.09f, 0.095f, 1};
    style.selected_color = {0.55f, 0.75f, 0.95f};
    inspect::CurveImage image = inspect::draw_curves(workspace.device, m_plot.layout, below, above, colors, style);
    m_plot.curve_count = photons.size();
    m_plot.selected_count = selected.size();
    m_plot.broken_count = below.broken_count + above.broken_count;
    m_pixels = std::move(image.pixels);
    workspace.pixels.set("parallel", image.width, image.height, m_pixels);
    for (std::size_t i = 0; i < m_plot.axes.size(); ++i)
        m_plot.densities.push_back(inspect::estimate_density(m_plot.columns[i], m_plot.axes[i], photons));
}

void ParallelPanel::update(Workspace& workspace, std::uint32_t width, std::uint32_t height) {
    const std::string key = write_key(workspace, width, height);
    if (key == m_plot.key)
        return;
    m_plot = {};
    m_plot.key = key;
    const Photons* photons = workspace.shown();
    if (!photons) {
        m_plot.missing = "there are no photons yet; open a scene";
        return;
    }
    const auto start = std::chrono::steady_clock::now();
    // Brushes choose among the photons shown: others may be shown now.
    if (const Ids brushed = find_brushed(workspace);
        brushed && (!workspace.state.selection || *brushed != *workspace.state.selection)) {
        workspace.select(brushed);
        m_plot.key = write_key(workspace, width, height);
    }
    find_axes(workspace);
    const std::string& source = workspace.state.parallel.source;
    const Ids ids = workspace.find_source(source);
    if (source == "loupe" && !ids)
        m_plot.missing = "the loupe sees no photons; move the cursor over some, or plot all of them";
    else if (source == "selection" && !ids)
        m_plot.missing = "nothing is selected; brush an axis, or plot all photons";
    else if (m_plot.axes.empty())
        m_plot.missing = "there are no axes; add one with +";
    if (!m_plot.missing.empty())
        return;
    try {
        m_plot.layout = inspect::place_axes(
            m_plot.axes, width, height,
            {56 * workspace.scale, 56 * workspace.scale, 34 * workspace.scale, 30 * workspace.scale});
        draw_curves(workspace, ids ? *ids : inspect::select_all(photons->map.count));
    } catch (const Error& error) {
        m_plot.missing = error.what();
    }
    workspace.plot_times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
}

void ParallelPanel::draw_axes(Workspace& workspace, float x, float y) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const auto place = [&](glm::vec2 point) { return ImVec2(x + point.x, y + point.y); };
    const auto fill = [&](const std::vector<glm::vec2>& outline, ImU32 color) {
        std::vector<ImVec2> points;
        for (const glm::vec2 point : outline)
            points.push_back(place(point));
        if (points.size() >= 3)
            list.AddConcavePolyFilled(points.data(), static_cast<int>(points.size()), color);
    };
    for (std::size_t i = 0; i < m_plot.axes.size(); ++i) {
        const inspect::Axis& axis = m_plot.axes[i];
        const inspect::AxisPlace& stand = m_plot.layout.places[i];
        const bool has_density = workspace.state.parallel.shows_density && i < m_plot.densities.size();
        if (has_density && !m_plot.densities[i].has_bars)
            fill_density(axis, stand, m_plot.densities[i], {x, y});
        else if (has_density)
            for (const auto& outline : inspect::outline_density(axis, stand, m_plot.densities[i], DENSITY_WIDTH))
                fill(outline, DENSITY_COLOR);
        if (stand.rx > 0)
            list.AddEllipse(place(stand.center), {stand.rx, stand.ry}, AXIS_COLOR, 0, 0, 1.5f);
        else
            list.AddLine(place(stand.center - glm::vec2(0, stand.ry)), place(stand.center + glm::vec2(0, stand.ry)),
                         AXIS_COLOR, 1.5f);
        for (const inspect::Interval& brush : axis.brushes)
            fill(inspect::outline_brush(axis, stand, brush, 5), BRUSH_COLOR);
        const std::string& label = m_plot.columns[i].label;
        const ImVec2 size = ImGui::CalcTextSize(label.c_str());
        const ImVec2 at = place(stand.center);
        list.AddText({at.x - 0.5f * size.x, y + 3}, AXIS_COLOR, label.c_str());
        const std::string low = format(axis.low), high = format(axis.high);
        const std::string below = stand.rx > 0 ? low + " = " + high : axis.is_flipped ? high : low;
        list.AddText({at.x - 0.5f * ImGui::CalcTextSize(below.c_str()).x, at.y + stand.ry + 3}, DIM_COLOR,
                     below.c_str());
        if (stand.rx == 0) {
            const std::string& above = axis.is_flipped ? low : high;
            list.AddText({at.x + 5, at.y - stand.ry - 2}, DIM_COLOR, above.c_str());
        }
        workspace.widgets["Parallel coordinates/" + m_plot.names[i]] = {
            at.x - std::max(stand.rx, 8.0f), at.y - stand.ry, 2 * std::max(stand.rx, 8.0f), 2 * stand.ry};
    }
}

void ParallelPanel::draw_axis_menu(Workspace& workspace) {
    if (!ImGui::BeginPopup("axis"))
        return;
    const std::size_t at = m_axis < m_plot.places.size() ? m_plot.places[m_axis] : 0;
    AxisState axis = list_axes(workspace)[at];
    const auto edit = [&](const char* name) {
        change_axes(workspace, name, [&](std::vector<AxisState>& axes) {
            axes[at] = axis;
            if (!axis.brushes.empty())
                workspace.select(find_brushed(workspace));
        });
    };
    ImGui::TextDisabled("%s", axis.name.c_str());
    if (ui::toggle(workspace, "Parallel coordinates/Closed", "closed (ellipse)", axis.is_closed))
        edit("close axis");
    ImGui::BeginDisabled(!axis.is_closed);
    ImGui::SetNextItemWidth(120 * workspace.scale);
    if (ui::slide(workspace, "Parallel coordinates/Periods", "periods", axis.periods, 1, 16))
        edit("periods");
    ImGui::EndDisabled();
    if (ui::toggle(workspace, "Parallel coordinates/Flipped", "flipped", axis.is_flipped))
        edit("flip axis");
    if (ui::button(workspace, "Parallel coordinates/Fit", "fit", "To the photons shown")) {
        fit_axis(workspace, axis);
        edit("fit axis");
    }
    ImGui::SameLine();
    if (ui::button(workspace, "Parallel coordinates/Whole", "whole range")) {
        axis.low = axis.high = 0;
        edit("whole range");
    }
    if (ui::button(workspace, "Parallel coordinates/Remove", "remove")) {
        change_axes(workspace, "remove axis", [&](std::vector<AxisState>& axes) {
            axes.erase(axes.begin() + static_cast<std::ptrdiff_t>(at));
            if (!axis.brushes.empty())
                workspace.select(find_brushed(workspace));
        });
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

void ParallelPanel::draw_toolbar(Workspace& workspace) {
    ParallelState parallel = workspace.state.parallel;
    const auto edit = [&](const char* name) {
        workspace.change(name, [&](StudioState& state) { state.parallel = parallel; });
    };
    ImGui::SetNextItemWidth(95 * workspace.scale);
    if (ui::choose(workspace, "Parallel coordinates/Source", "##source", parallel.source, {"loupe", "all", "selection"},
                   "Which photons are plotted"))
        edit("plotted photons");
    ui::beside(workspace, 120);
    if (ui::choose_column(workspace, "Parallel coordinates/Color", "##color", parallel.color, "encoding"))
        edit("curve colors");
    ui::beside(workspace, 80);
    if (ui::slide(workspace, "Parallel coordinates/Tension", "##tension", parallel.tension, 0, 1, "tension %.2f"))
        edit("tension");
    ImGui::SameLine();
    if (ui::toggle(workspace, "Parallel coordinates/Density", "density", parallel.shows_density))
        edit("density");
    std::string added = "+ axis";
    ui::beside(workspace, 90);
    if (ui::choose_column(workspace, "Parallel coordinates/Add", "##add", added))
        change_axes(workspace, "add axis", [&](std::vector<AxisState>& axes) {
            if (axes.size() < MOST_AXES) {
                axes.emplace_back();
                axes.back().name = added;
            }
        });
    ImGui::SameLine();
    if (ui::button(workspace, "Parallel coordinates/FitAll", "Fit", "Every open axis to the photons shown"))
        change_axes(workspace, "fit axes", [&](std::vector<AxisState>& axes) {
            for (AxisState& axis : axes)
                if (!axis.is_closed)
                    fit_axis(workspace, axis);
        });
    ImGui::SameLine();
    if (ui::button(workspace, "Parallel coordinates/Reset", "Reset", "The first axes again"))
        reset_axes(workspace);
    ImGui::SameLine();
    draw_selection_menu(workspace);
    ImGui::SameLine();
    std::string told = std::to_string(m_plot.curve_count) + " photons";
    if (workspace.state.selection)
        told += ", " + std::to_string(m_plot.selected_count) + " selected";
    if (m_plot.broken_count > 0)
        told += ", " + std::to_string(m_plot.broken_count) + " lack a value";
    ImGui::TextDisabled("%s", told.c_str());
}

void ParallelPanel::draw(Workspace& workspace) {
    draw_toolbar(workspace);
    const ImVec2 low = ImGui::GetCursorScreenPos(), free = ImGui::GetContentRegionAvail();
    const auto width = static_cast<std::uint32_t>(std::max(free.x, 32.0f));
    const auto height = static_cast<std::uint32_t>(std::max(free.y, 32.0f));
    update(workspace, width, height);
    if (!m_plot.missing.empty()) {
        ui::say_empty(m_plot.missing);
        return;
    }
    ImGui::InvisibleButton("##plot", {static_cast<float>(width), static_cast<float>(height)},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    ui::mark(workspace, "Parallel coordinates/Plot");
    if (ImGui::IsItemClicked(1)) {
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        if (const auto axis = inspect::find_axis(m_plot.layout, {mouse.x - low.x, mouse.y - low.y}, 30)) {
            m_axis = *axis;
            ImGui::OpenPopup("axis");
        }
    }
    take_mouse(workspace, low.x, low.y);
    if (const std::uint64_t texture = workspace.pixels.find("parallel"))
        ImGui::GetWindowDrawList()->AddImage(static_cast<ImTextureID>(texture), low,
                                             {low.x + static_cast<float>(width), low.y + static_cast<float>(height)});
    draw_axes(workspace, low.x, low.y);
    draw_axis_menu(workspace);
}

} // namespace photonloupe::studio
