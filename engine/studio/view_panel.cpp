// SPDX-License-Identifier: Apache-2.0
// Lays out the view and turns the mouse into camera, loupe and pins.
#include "studio/view_panel.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "inspect/photon_colors.h"
#include "photons/map_columns.h"
#include "studio/camera.h"
#include "studio/edit_state.h"
#include "studio/loupe_query.h"
#include "studio/python_script.h"
#include "studio/theme.h"
#include "studio/widgets.h"

namespace photonloupe::studio {
namespace {

constexpr const char* MODE_NAMES[] = {"1 points",       "2 Voronoi cells",      "3 kd-tree", "4 false color points",
                                      "5 final render", "6 false color render", "7 map"};
constexpr ImU32 LABEL_COLOR = 0xffe0e0e0;
constexpr float ORBIT_SPEED = 0.006f;  // radians a pixel
constexpr float SPLIT_REACH = 5.0f;    // pixels from the line that take hold of it
constexpr float DRAG_THRESHOLD = 4.0f; // pixels before a click is a drag

// The picture's place in the free room: all of it, or, of renders, what has their aspect.
ViewFrame place_frame(const Workspace& workspace, ImVec2 low, ImVec2 room) {
    ViewFrame frame{low.x, low.y, std::floor(room.x), std::floor(room.y), {}, {}};
    if (shows_render(workspace.state.view.mode)) {
        const float scale = std::min(room.x / RENDER_WIDTH, room.y / RENDER_HEIGHT);
        frame.width = RENDER_WIDTH * scale;
        frame.height = RENDER_HEIGHT * scale;
        frame.x += 0.5f * (room.x - frame.width);
        frame.y += 0.5f * (room.y - frame.height);
    }
    if (workspace.results.scene)
        frame.origin = workspace.results.scene->origin;
    else if (workspace.results.photons)
        frame.origin = workspace.results.photons->map.origin;
    frame.camera = frame_camera(frame.origin, find_pose(workspace.state.view.camera),
                                static_cast<std::uint32_t>(frame.width), static_cast<std::uint32_t>(frame.height));
    return frame;
}

// Without surfaces: the photon that is nearest to the cursor on the screen.
std::optional<std::uint32_t> find_photon_at(const Photons& photons, const ViewFrame& frame, float x, float y) {
    constexpr float REACH = 40.0f;
    const std::vector<float> positions = read_positions(photons.map);
    std::optional<std::uint32_t> nearest;
    float least = REACH * REACH;
    for (std::size_t i = 0; i < photons.map.count; ++i) {
        const glm::vec3 pixel = find_pixel(frame, {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]});
        const float distance = (pixel.x - x) * (pixel.x - x) + (pixel.y - y) * (pixel.y - y);
        if (pixel.z > 0 && distance < least) {
            least = distance;
            nearest = static_cast<std::uint32_t>(i);
        }
    }
    return nearest;
}

// What the colors of the map stand for.
void draw_color_bar(Workspace& workspace, const ViewFrame& frame) {
    constexpr int STEPS = 64;
    const inspect::Column* column = workspace.seek_column(workspace.state.view.map_column);
    if (!column)
        return;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const inspect::Colormap map = inspect::choose_colormap(*column);
    const float width = 12 * workspace.scale, height = std::min(160 * workspace.scale, 0.5f * frame.height);
    const float left = frame.x + frame.width - width - 64 * workspace.scale, top = frame.y + 34 * workspace.scale;
    const float step = height / STEPS;
    for (int i = 0; i < STEPS; ++i) {
        const glm::vec3 color = inspect::map_color(map, 1 - (static_cast<float>(i) + 0.5f) / STEPS);
        const float y = top + static_cast<float>(i) * step;
        list.AddRectFilled({left, y}, {left + width, y + step + 1},
                           ImGui::ColorConvertFloat4ToU32({color.r, color.g, color.b, 1}));
    }
    char low[32], high[32];
    std::snprintf(low, sizeof low, "%.3g", static_cast<double>(column->low));
    std::snprintf(high, sizeof high, "%.3g", static_cast<double>(column->high));
    const float line = ImGui::GetTextLineHeight();
    list.AddText({left + width + 5, top - 0.3f * line}, LABEL_COLOR, high);
    list.AddText({left + width + 5, top + height - 0.7f * line}, LABEL_COLOR, low);
    const float text = ImGui::CalcTextSize(column->label.c_str()).x;
    list.AddText({frame.x + frame.width - text - 12, top - 1.6f * line}, LABEL_COLOR, column->label.c_str());
}

} // namespace

glm::vec3 find_pixel(const ViewFrame& frame, const std::array<double, 3>& place) {
    glm::vec3 local;
    for (int i = 0; i < 3; ++i)
        local[i] = static_cast<float>(place[static_cast<std::size_t>(i)] - frame.origin[static_cast<std::size_t>(i)]);
    const glm::vec3 pixel =
        project(frame.camera, local, static_cast<std::uint32_t>(frame.width), static_cast<std::uint32_t>(frame.height));
    return {pixel.x + frame.x, pixel.y + frame.y, pixel.z};
}

void ViewPanel::draw_toolbar(Workspace& workspace) {
    ImGui::SetNextItemWidth(170 * workspace.scale);
    std::string mode = MODE_NAMES[static_cast<int>(workspace.state.view.mode) - 1];
    if (ui::choose(workspace, "View/Mode", "##mode", mode, {std::begin(MODE_NAMES), std::end(MODE_NAMES)}))
        set_mode(workspace, static_cast<ViewMode>(std::find(std::begin(MODE_NAMES), std::end(MODE_NAMES), mode) -
                                                  std::begin(MODE_NAMES) + 1));
    ViewState view = workspace.state.view;
    const auto edit = [&](const char* name) { workspace.change(name, [&](StudioState& state) { state.view = view; }); };
    if (view.mode == ViewMode::map) {
        ui::beside(workspace, 140);
        if (ui::choose_column(workspace, "View/Column", "##column", view.map_column))
            edit("map");
    }
    if (view.mode == ViewMode::kd_tree) {
        ui::beside(workspace, 110);
        if (ImGui::SliderInt("##depth", &view.tree_depth, -1, 24, view.tree_depth < 0 ? "leaves" : "depth %d",
                             ImGuiSliderFlags_AlwaysClamp))
            edit("tree depth");
        ui::mark(workspace, "View/Depth");
    }
    if (!shows_render(view.mode) && view.mode != ViewMode::voronoi && view.mode != ViewMode::kd_tree) {
        ui::beside(workspace, 90);
        if (ui::slide(workspace, "View/Size", "##size", view.point_size, 1.0f, 16.0f, "%.1f px"))
            edit("point size");
        ui::beside(workspace, 90);
        if (ui::slide(workspace, "View/Brightness", "##brightness", view.brightness, -6.0f, 6.0f, "%.1f stops"))
            edit("brightness");
    }
    ImGui::SameLine();
    if (ui::button(workspace, "View/Frame", "Frame", "Frame the selection, or all photons (F)"))
        frame_selection(workspace);
    ImGui::SameLine();
    if (ui::button(workspace, "View/Straight", "Straight", "Look straight at the receiver (R)"))
        look_straight(workspace);
    ImGui::SameLine();
    ImGui::BeginDisabled(!workspace.has_relaxed());
    if (ui::toggle(workspace, "View/After", "after", view.shows_relaxed, "Relaxed photons (Tab)"))
        toggle_relaxed(workspace);
    ImGui::SameLine();
    if (ui::toggle(workspace, "View/Split", "split", view.is_split, "Before and after side by side (S)"))
        toggle_split(workspace);
    ImGui::EndDisabled();
}

void ViewPanel::draw_images(Workspace& workspace, const ViewFrame& frame) {
    const ViewState& view = workspace.state.view;
    const bool is_split = view.is_split && workspace.has_relaxed() && !shows_render(view.mode);
    const auto width = static_cast<std::uint32_t>(frame.width), height = static_cast<std::uint32_t>(frame.height);
    const float line = frame.x + frame.width * view.split_at;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    std::string missing;
    const auto show = [&](ViewPicture& picture, bool relaxed, float left, float right) {
        std::string lacking;
        picture.update(workspace, relaxed, width, height, lacking);
        if (missing.empty())
            missing = lacking;
        const std::uint64_t texture = picture.find_texture(workspace);
        if (!texture || !lacking.empty())
            return;
        const float u0 = (left - frame.x) / frame.width, u1 = (right - frame.x) / frame.width;
        list.AddImage(static_cast<ImTextureID>(texture), {left, frame.y}, {right, frame.y + frame.height}, {u0, 0},
                      {u1, 1});
    };
    if (is_split) {
        show(m_before, false, frame.x, line);
        show(m_after, true, line, frame.x + frame.width);
        list.AddLine({line, frame.y}, {line, frame.y + frame.height}, ACCENT_COLOR, 2);
        list.AddText({line - 50 * workspace.scale, frame.y + 4}, DIM_COLOR, "before");
        list.AddText({line + 8, frame.y + 4}, DIM_COLOR, "after");
    } else {
        show(view.shows_relaxed ? m_after : m_before, view.shows_relaxed, frame.x, frame.x + frame.width);
    }
    if (view.mode == ViewMode::map && missing.empty())
        draw_color_bar(workspace, frame);
    if (!missing.empty()) {
        ImGui::SetCursorScreenPos({frame.x + 12, frame.y + 12});
        ui::say_empty(missing);
    }
}

void ViewPanel::move_under_cursor(Workspace& workspace, const ViewFrame& frame, float x, float y) {
    Photons* photons = workspace.shown();
    if (!photons)
        return;
    const ViewPicture& picture = workspace.state.view.shows_relaxed ? m_after : m_before;
    if (picture.has_surfaces()) {
        const auto seen = picture.seek_surface((x - frame.x) / frame.width, (y - frame.y) / frame.height);
        if (seen)
            move_loupe(workspace, seen->position, seen->normal);
        return;
    }
    const std::optional<std::uint32_t> photon = find_photon_at(*photons, frame, x, y);
    if (!photon)
        return;
    const std::vector<float> positions = read_positions(photons->map);
    move_loupe(workspace, {positions[3 * *photon], positions[3 * *photon + 1], positions[3 * *photon + 2]},
               std::nullopt);
}

void ViewPanel::take_mouse(Workspace& workspace, const ViewFrame& frame) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool is_over = ImGui::IsItemHovered(), is_active = ImGui::IsItemActive();
    const float line = frame.x + frame.width * workspace.state.view.split_at;
    const bool is_split =
        workspace.state.view.is_split && workspace.has_relaxed() && !shows_render(workspace.state.view.mode);
    if (ImGui::IsItemActivated()) {
        m_is_dragging = false;
        m_drags_split = is_split && std::abs(io.MousePos.x - line) <= SPLIT_REACH * workspace.scale;
    }
    if (is_over && io.MouseWheel != 0 && io.KeyCtrl)
        workspace.change("zoom", [&](StudioState& state) { zoom(state.view.camera, io.MouseWheel); });
    else if (is_over && io.MouseWheel != 0)
        io.MouseWheel > 0 ? grow_loupe(workspace) : shrink_loupe(workspace);
    const int button = ImGui::IsMouseDown(1) ? 1 : ImGui::IsMouseDown(2) ? 2 : 0;
    if (is_active && ImGui::IsMouseDragging(button, DRAG_THRESHOLD)) {
        m_is_dragging = true;
        const ImVec2 moved = io.MouseDelta;
        if (m_drags_split)
            workspace.change("split", [&](StudioState& state) {
                state.view.split_at = std::clamp((io.MousePos.x - frame.x) / frame.width, 0.0f, 1.0f);
            });
        else if ((moved.x != 0 || moved.y != 0) && button == 0)
            workspace.change("orbit", [&](StudioState& state) {
                orbit(state.view.camera, moved.x * ORBIT_SPEED, moved.y * ORBIT_SPEED);
            });
        else if (moved.x != 0 || moved.y != 0)
            workspace.change("pan", [&](StudioState& state) {
                pan(state.view.camera, moved.x / frame.height, -moved.y / frame.height);
            });
        return;
    }
    const bool has_moved = io.MousePos.x != m_mouse_x || io.MousePos.y != m_mouse_y;
    m_mouse_x = io.MousePos.x;
    m_mouse_y = io.MousePos.y;
    if (is_over && has_moved && !is_active)
        move_under_cursor(workspace, frame, io.MousePos.x, io.MousePos.y);
    if (ImGui::IsItemDeactivated() && !m_is_dragging && ImGui::IsMouseReleased(0)) {
        move_under_cursor(workspace, frame, io.MousePos.x, io.MousePos.y);
        update_loupe(workspace);
        pin_photon(workspace);
    }
}

void ViewPanel::draw_picture(Workspace& workspace) {
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImVec2 free = ImGui::GetContentRegionAvail();
    const ImVec2 room(std::max(free.x, 16.0f), std::max(free.y, 16.0f));
    ImGui::InvisibleButton("##picture", room,
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    ui::mark(workspace, "View/Picture");
    ImGui::SetItemKeyOwner(ImGuiKey_MouseWheelY);
    const ViewFrame frame = place_frame(workspace, low, room);
    take_mouse(workspace, frame);
    ImGui::PushClipRect(low, {low.x + room.x, low.y + room.y}, true);
    draw_images(workspace, frame);
    update_loupe(workspace);
    draw_loupe(workspace, frame);
    ImGui::PopClipRect();
}

void ViewPanel::draw(Workspace& workspace) {
    draw_toolbar(workspace);
    draw_picture(workspace);
}

} // namespace photonloupe::studio
