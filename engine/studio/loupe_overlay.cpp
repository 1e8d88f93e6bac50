// SPDX-License-Identifier: Apache-2.0
// Draws the loupe over the view ([SJL15] figure 6 a): its circle and photons, the constraint basis as two arrows whose
// length is freedom, drift ellipses, light paths and pins.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <imgui.h>

#include "studio/theme.h"
#include "studio/view_panel.h"

namespace photonloupe::studio {
namespace {

constexpr int CIRCLE_SEGMENTS = 64;
constexpr int ELLIPSE_SEGMENTS = 16;
constexpr float SMALLEST_ARROW = 0.04f; // of the loupe's radius: a fixed direction is still seen
constexpr std::size_t MOST_PATHS = 64;
constexpr ImU32 FOUND_COLOR = 0xd0ffffff, RING_COLOR = 0xc0ffb050, PIN_COLOR = 0xff40b0ff, DRIFT_COLOR = 0x90ffd080;

using Place = std::array<double, 3>;

Place offset(const Place& origin, glm::vec3 local) {
    return {origin[0] + static_cast<double>(local.x), origin[1] + static_cast<double>(local.y),
            origin[2] + static_cast<double>(local.z)};
}

class Pen {
public:
    Pen(const ViewFrame& frame, const inspect::LoupeView& view) : m_frame(frame), m_view(view) {}

    // Relative to the map's origin; nothing behind the camera.
    std::optional<ImVec2> find(glm::vec3 local) const {
        const glm::vec3 pixel = find_pixel(m_frame, offset(m_view.origin, local));
        return pixel.z > 0 ? std::optional(ImVec2(pixel.x, pixel.y)) : std::nullopt;
    }
    void loop(glm::vec3 center, glm::vec3 right, glm::vec3 up, int segments, ImU32 color, float width) const {
        std::vector<ImVec2> points;
        for (int i = 0; i < segments; ++i) {
            const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(segments);
            if (const auto point = find(center + std::cos(angle) * right + std::sin(angle) * up))
                points.push_back(*point);
        }
        ImGui::GetWindowDrawList()->AddPolyline(points.data(), static_cast<int>(points.size()), color, width,
                                                ImDrawFlags_Closed);
    }
    void arrow(glm::vec3 from, glm::vec3 way, ImU32 color, float width) const {
        const auto tail = find(from - way), head = find(from + way);
        if (!tail || !head)
            return;
        ImDrawList& list = *ImGui::GetWindowDrawList();
        list.AddLine(*tail, *head, color, width);
        const ImVec2 step(head->x - tail->x, head->y - tail->y);
        const float length = std::hypot(step.x, step.y);
        if (length < 4)
            return;
        const float size = std::min(4 * width, 0.4f * length) / length;
        for (const auto& [end, sign] : {std::pair(*head, -1.0f), std::pair(*tail, 1.0f)})
            list.AddTriangleFilled(
                end, {end.x + sign * size * (step.x + 0.5f * step.y), end.y + sign * size * (step.y - 0.5f * step.x)},
                {end.x + sign * size * (step.x - 0.5f * step.y), end.y + sign * size * (step.y + 0.5f * step.x)},
                color);
    }

private:
    const ViewFrame& m_frame;
    const inspect::LoupeView& m_view;
};

void find_tangents(glm::vec3 normal, glm::vec3& right, glm::vec3& up) {
    const glm::vec3 other = std::abs(normal.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    right = glm::normalize(glm::cross(other, normal));
    up = glm::cross(normal, right);
}

void draw_found(const Pen& pen, const inspect::LoupeView& view, float scale) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float radius = view.ids.size() > 400 ? 1.3f : 2.0f;
    for (const glm::vec3& position : view.positions)
        if (const auto point = pen.find(position))
            list.AddCircleFilled(*point, radius * scale, FOUND_COLOR, 8);
}

void draw_drift(const Pen& pen, const inspect::LoupeView& view) {
    for (std::size_t i = 0; i < view.ellipses.size(); ++i) {
        const inspect::DriftEllipse& ellipse = view.ellipses[i];
        pen.loop(view.positions[i], ellipse.along * ellipse.half_along, ellipse.across * ellipse.half_across,
                 ELLIPSE_SEGMENTS, DRIFT_COLOR, 1);
    }
}

void draw_paths(Workspace& workspace, const Pen& pen, const inspect::LoupeView& view) {
    const Photons* photons = workspace.shown();
    if (!photons || !photons->map.paths)
        return;
    const std::size_t count = std::min(view.ids.size(), MOST_PATHS);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (const inspect::PathLine& line : inspect::read_path_lines(*photons, std::span(view.ids).first(count)))
        for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
            const auto from = pen.find(line.points[i]), to = pen.find(line.points[i + 1]);
            if (from && to)
                list.AddLine(*from, *to, PATH_COLOR, 1);
        }
}

void draw_basis(const Pen& pen, const inspect::LoupeView& view, float reach) {
    const float along = std::max(view.freedom_along, SMALLEST_ARROW),
                across = std::max(view.freedom_across, SMALLEST_ARROW);
    pen.arrow(view.center_position, reach * along * view.along, ALONG_COLOR, 2);
    pen.arrow(view.center_position, reach * across * view.across, ACROSS_COLOR, 2);
}

void draw_view(Workspace& workspace, const ViewFrame& frame, const inspect::LoupeView& view, ImU32 ring) {
    const Pen pen(frame, view);
    if (!view.center)
        return;
    if (workspace.state.loupe.shows_paths)
        draw_paths(workspace, pen, view);
    draw_found(pen, view, workspace.scale);
    if (workspace.state.loupe.shows_drift)
        draw_drift(pen, view);
    glm::vec3 right, up;
    find_tangents(view.center_normal, right, up);
    // In parameter space the found may lie anywhere: the circle then only marks the place.
    const float reach = view.radius > 0 && std::isfinite(view.radius) ? view.radius : 0.0f;
    if (workspace.state.loupe.space != SearchSpace::parameter)
        pen.loop(view.place, reach * right, reach * up, CIRCLE_SEGMENTS, ring, 1.5f);
    draw_basis(pen, view, 0.8f * reach);
    if (const auto center = pen.find(view.center_position))
        ImGui::GetWindowDrawList()->AddCircle(*center, 4 * workspace.scale, ring, 0, 2);
}

} // namespace

void draw_loupe(Workspace& workspace, const ViewFrame& frame) {
    for (const auto& [pin, view] : workspace.pinned) {
        const Pen pen(frame, view);
        if (const auto place = pen.find(view.center_position)) {
            ImGui::GetWindowDrawList()->AddCircle(*place, 6 * workspace.scale, PIN_COLOR, 0, 2);
            ImGui::GetWindowDrawList()->AddText({place->x + 8, place->y - 8}, PIN_COLOR,
                                                ("#" + std::to_string(pin)).c_str());
        }
    }
    if (workspace.loupe)
        draw_view(workspace, frame, *workspace.loupe, RING_COLOR);
}

} // namespace photonloupe::studio
