// SPDX-License-Identifier: Apache-2.0
// What the mouse does to the axes: brushes them, moves them, zooms into them.
#include <algorithm>

#include <imgui.h>

#include "studio/edit_axes.h"
#include "studio/parallel_panel.h"

namespace photonloupe::studio {
namespace {

constexpr float REACH = 14; // pixels from an axis that take hold of it

} // namespace

void ParallelPanel::brush(Workspace& workspace, float to) {
    const std::size_t at = m_plot.places[m_axis];
    const bool wraps = m_plot.axes[m_axis].is_closed;
    change_axes(workspace, "brush", [&](std::vector<AxisState>& axes) {
        auto& brushes = axes[at].brushes;
        if (m_is_new && !m_adds)
            brushes.clear();
        if (m_is_new || brushes.empty())
            brushes.emplace_back();
        m_is_new = false;
        brushes.back() = wraps ? std::array{m_begin, to} : std::array{std::min(m_begin, to), std::max(m_begin, to)};
        workspace.select(find_brushed(workspace));
    });
}

void ParallelPanel::grip_axis(float column, float row) {
    const ImGuiIO& io = ImGui::GetIO();
    const std::optional<std::size_t> axis = inspect::find_axis(m_plot.layout, {column, row}, REACH * m_scale);
    m_grip = Grip::none;
    if (!axis || ImGui::IsMouseDown(1))
        return;
    m_axis = *axis;
    m_begin = inspect::find_value(m_plot.axes[m_axis], m_plot.layout.places[m_axis], {column, row});
    m_grip = io.KeyAlt ? Grip::move : io.KeyShift ? Grip::zoom : Grip::brush;
    m_has_moved = false;
    m_is_new = true;
    m_adds = io.KeyCtrl;
}

void ParallelPanel::release_axis(Workspace& workspace, float column, float end) {
    const std::size_t at = m_plot.places[m_axis];
    if (m_grip == Grip::move)
        change_axes(workspace, "move axis", [&](std::vector<AxisState>& axes) {
            std::size_t to = 0;
            for (std::size_t i = 0; i < m_plot.layout.places.size(); ++i)
                if (i != m_axis && m_plot.layout.places[i].center.x < column)
                    ++to;
            const AxisState moved = axes[at];
            axes.erase(axes.begin() + static_cast<std::ptrdiff_t>(at));
            axes.insert(axes.begin() + static_cast<std::ptrdiff_t>(std::min(to, axes.size())), moved);
        });
    if (m_grip == Grip::zoom)
        change_axes(workspace, "zoom axis", [&](std::vector<AxisState>& axes) {
            axes[at].low = std::min(m_begin, end);
            axes[at].high = std::max(m_begin, end);
        });
    // A click takes the axis' brushes away.
    if (m_grip == Grip::brush && !m_has_moved && !list_axes(workspace)[at].brushes.empty())
        change_axes(workspace, "brush", [&](std::vector<AxisState>& axes) {
            axes[at].brushes.clear();
            workspace.select(find_brushed(workspace));
        });
    m_grip = Grip::none;
}

void ParallelPanel::take_mouse(Workspace& workspace, float x, float y) {
    const ImGuiIO& io = ImGui::GetIO();
    const glm::vec2 pixel(io.MousePos.x - x, io.MousePos.y - y);
    if (!m_plot.missing.empty() || m_axis >= m_plot.axes.size())
        m_grip = Grip::none; // the axes have changed under the mouse
    if (!m_plot.missing.empty() || m_plot.axes.empty())
        return;
    m_scale = workspace.scale;
    if (ImGui::IsItemActivated())
        grip_axis(pixel.x, pixel.y);
    if (m_grip == Grip::none)
        return;
    m_has_moved |= ImGui::IsItemActive() && ImGui::IsMouseDragging(0, 2);
    const float end = inspect::find_value(m_plot.axes[m_axis], m_plot.layout.places[m_axis], pixel, m_begin);
    if (ImGui::IsItemActive() && m_grip == Grip::brush && m_has_moved)
        brush(workspace, end);
    if (ImGui::IsItemDeactivated())
        release_axis(workspace, pixel.x, end);
}

} // namespace photonloupe::studio
