// SPDX-License-Identifier: Apache-2.0
// Plots by engine/inspect; draws frame, labels and lasso over it.
#include "studio/scatter_panel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <imgui.h>

#include "core/error.h"
#include "inspect/histogram.h"
#include "inspect/photon_colors.h"
#include "studio/edit_state.h"
#include "studio/theme.h"
#include "studio/widgets.h"

namespace photonloupe::studio {
namespace {

constexpr std::size_t SMALLEST_LASSO = 3;
constexpr double PAIR_ROOM = 0.9;                  // half a plot, in extents of the loupe's photons
constexpr double PAIR_REST = 0.02;                 // of them at either end, that took another way and lie far off
constexpr glm::vec3 PLAIN_COLOR(0.3f, 0.5f, 0.8f); // of photons that no script gave a color

// Linear colors, as the plot takes them.
std::vector<glm::vec3> list_colors(Workspace& workspace, std::size_t count) {
    std::vector<glm::vec3> colors;
    if (workspace.find_colors("encoding").empty())
        colors.assign(count, PLAIN_COLOR);
    for (const std::uint32_t packed : workspace.find_colors("encoding"))
        colors.push_back(inspect::linearize(glm::vec3(packed & 255, packed >> 8 & 255, packed >> 16 & 255) / 255.0f));
    return colors;
}

// Both axes to one scale, about the photons: a disc in the world looks like a disc, and its image like what it became.
void fit_ranges(inspect::ScatterSettings& settings, const inspect::Column& x, const inspect::Column& y,
                const inspect::Selection& photons) {
    std::array<std::vector<float>, 2> values;
    for (const std::uint32_t id : photons)
        if (std::isfinite(x.values[id]) && std::isfinite(y.values[id])) {
            values[0].push_back(x.values[id]);
            values[1].push_back(y.values[id]);
        }
    if (values[0].empty())
        return;
    glm::dvec2 low, high;
    for (int i = 0; i < 2; ++i) {
        low[i] = inspect::find_quantile(values[static_cast<std::size_t>(i)], PAIR_REST);
        high[i] = inspect::find_quantile(values[static_cast<std::size_t>(i)], 1 - PAIR_REST);
    }
    const glm::dvec2 pixels(settings.width, settings.height);
    const glm::dvec2 extent = (high - low) / pixels;
    const double reach = PAIR_ROOM * std::max(extent.x, extent.y); // a pixel's
    if (!(reach > 0))
        return;
    const glm::dvec2 middle = 0.5 * (low + high), half = reach * pixels;
    settings.x_range = {middle.x - half.x, middle.x + half.x};
    settings.y_range = {middle.y - half.y, middle.y + half.y};
}

std::string format_range(const inspect::Column& column, const inspect::Range& range) {
    char text[160];
    std::snprintf(text, sizeof text, "%s: %.3g … %.3g", column.label.c_str(), range.first, range.second);
    return text;
}

} // namespace

void ScatterPanel::update(Workspace& workspace, Plot& plot, const std::string& texture, const std::string& x,
                          const std::string& y, bool is_polar, std::uint32_t width, std::uint32_t height) {
    const ScatterState& scatter = workspace.state.scatter;
    const std::string source = scatter.shows_pair ? "loupe" : scatter.source;
    const std::string key =
        write_values(x, y, source, is_polar, scatter.shows_pair, width, height, workspace.results.photons_version,
                     workspace.selection_version, workspace.state.view.shows_relaxed,
                     source == "loupe" ? workspace.loupe_result_version : 0);
    if (key == plot.key)
        return;
    plot = {};
    plot.key = key;
    const inspect::Column* across = workspace.seek_column(x, &plot.missing);
    const inspect::Column* up = across ? workspace.seek_column(y, &plot.missing) : nullptr;
    if (!across || !up)
        return;
    plot.x = *across;
    plot.y = *up;
    Ids shown = workspace.find_source(source);
    if (source != "all" && !shown) {
        plot.missing = source == "loupe" ? "the loupe sees no photons; move the cursor over some"
                                         : "nothing is selected; brush an axis, or draw a lasso over all photons";
        return;
    }
    // The loupe's photons stand out from the rest; brushes and lassos likewise.
    const Ids chosen = shown ? shown : workspace.state.selection;
    inspect::ScatterSettings settings;
    settings.width = width;
    settings.height = height;
    settings.is_polar = is_polar;
    if (scatter.shows_pair && shown && !is_polar)
        fit_ranges(settings, plot.x, plot.y, *shown);
    try {
        const inspect::ScatterPlot drawn = inspect::plot_scatter(
            plot.x, plot.y, list_colors(workspace, plot.x.values.size()), chosen ? &*chosen : nullptr, settings);
        std::vector<std::uint32_t> pixels(drawn.rgba.size() / 4);
        for (std::size_t i = 0; i < pixels.size(); ++i)
            pixels[i] = drawn.rgba[4 * i] | drawn.rgba[4 * i + 1] << 8 | drawn.rgba[4 * i + 2] << 16 |
                        std::uint32_t{drawn.rgba[4 * i + 3]} << 24;
        plot.frame = drawn.frame;
        plot.drawn_count = drawn.drawn_count;
        workspace.pixels.set(texture, width, height, std::move(pixels));
    } catch (const Error& error) {
        plot.missing = error.what();
    }
}

void ScatterPanel::show(Workspace& workspace, const Plot& plot, const std::string& texture, float x, float y,
                        float width, float height) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({x, y}, {x + width, y + height}, 0xff181615);
    if (const std::uint64_t id = workspace.pixels.find(texture))
        list.AddImage(static_cast<ImTextureID>(id), {x, y}, {x + width, y + height});
    list.AddRect({x, y}, {x + width, y + height}, 0xff504c48);
    if (!plot.frame)
        return;
    const float line = ImGui::GetTextLineHeight();
    list.AddText({x + 6, y + height - line - 4}, DIM_COLOR, format_range(plot.x, plot.frame->x_range()).c_str());
    list.AddText({x + 6, y + 4}, DIM_COLOR, format_range(plot.y, plot.frame->y_range()).c_str());
}

void ScatterPanel::take_lasso(Workspace& workspace, const Plot& plot, float x, float y) {
    const ImGuiIO& io = ImGui::GetIO();
    const glm::vec2 pixel(io.MousePos.x - x, io.MousePos.y - y);
    if (ImGui::IsItemActivated()) {
        m_lasso.assign(1, pixel);
        m_is_lassoing = true;
    }
    if (ImGui::IsItemActive() && m_is_lassoing && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0))
        m_lasso.push_back(pixel);
    if (m_lasso.size() > 1 && m_is_lassoing) {
        std::vector<ImVec2> points;
        for (const glm::vec2 point : m_lasso)
            points.emplace_back(x + point.x, y + point.y);
        ImGui::GetWindowDrawList()->AddPolyline(points.data(), static_cast<int>(points.size()), ACCENT_COLOR, 1.5f,
                                                ImDrawFlags_Closed);
    }
    if (!ImGui::IsItemDeactivated() || !m_is_lassoing)
        return;
    m_is_lassoing = false;
    if (m_lasso.size() < SMALLEST_LASSO || !plot.frame) {
        workspace.change("select nothing", [&](StudioState&) { workspace.select(nullptr); });
        return;
    }
    std::vector<glm::dvec2> polygon(m_lasso.begin(), m_lasso.end());
    select_instead(workspace, "lasso",
                   std::make_shared<const std::vector<std::uint32_t>>(
                       inspect::find_in_lasso(plot.x, plot.y, *plot.frame, polygon)));
}

void ScatterPanel::draw_toolbar(Workspace& workspace) {
    ScatterState scatter = workspace.state.scatter;
    const auto edit = [&](const char* name) {
        workspace.change(name, [&](StudioState& state) { state.scatter = scatter; });
    };
    ImGui::SetNextItemWidth(120 * workspace.scale);
    if (ui::choose_column(workspace, "Parameter space/X", scatter.is_polar ? "angle" : "x", scatter.x))
        edit("scatter x");
    ui::beside(workspace, 120);
    if (ui::choose_column(workspace, "Parameter space/Y", scatter.is_polar ? "radius" : "y", scatter.y))
        edit("scatter y");
    ImGui::SameLine();
    if (ui::toggle(workspace, "Parameter space/Polar", "polar", scatter.is_polar))
        edit("polar");
    ui::beside(workspace, 90);
    if (ui::choose(workspace, "Parameter space/Source", "##source", scatter.source, {"loupe", "all", "selection"},
                   "Which photons stand out"))
        edit("scattered photons");
    ImGui::SameLine();
    if (ui::toggle(workspace, "Parameter space/Pair", "world beside", scatter.shows_pair,
                   "The loupe's photons in world space and in parameter space"))
        edit("world beside");
}

void ScatterPanel::draw(Workspace& workspace) {
    draw_toolbar(workspace);
    const ImVec2 low = ImGui::GetCursorScreenPos(), free = ImGui::GetContentRegionAvail();
    const ScatterState& scatter = workspace.state.scatter;
    const float gap = 6;
    const float width = std::floor(scatter.shows_pair ? 0.5f * (free.x - gap) : free.x);
    const float height = std::floor(free.y);
    if (width < 16 || height < 16)
        return;
    const auto columns = static_cast<std::uint32_t>(width), rows = static_cast<std::uint32_t>(height);
    float left = low.x;
    if (scatter.shows_pair) {
        update(workspace, m_world, "scatter world", "x", "z", false, columns, rows);
        show(workspace, m_world, "scatter world", left, low.y, width, height);
        left += width + gap;
    }
    update(workspace, m_plot, "scatter", scatter.x, scatter.y, scatter.is_polar, columns, rows);
    if (!m_plot.missing.empty()) {
        ui::say_empty(m_plot.missing);
        return;
    }
    ImGui::SetCursorScreenPos({left, low.y});
    ImGui::InvisibleButton("##scatter", {width, height});
    ui::mark(workspace, "Parameter space/Plot");
    show(workspace, m_plot, "scatter", left, low.y, width, height);
    take_lasso(workspace, m_plot, left, low.y);
}

} // namespace photonloupe::studio
