// SPDX-License-Identifier: Apache-2.0
// Draws points and cells by engine/inspect, and remembers by a key what they were drawn of.
#include "studio/view_picture.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/error.h"
#include "image/png.h"
#include "inspect/kd_cells.h"
#include "inspect/photon_colors.h"
#include "inspect/splat_photons.h"
#include "inspect/voronoi.h"
#include "studio/camera.h"
#include "studio/tone_map.h"

namespace photonloupe::studio {
namespace {

constexpr std::uint32_t COARSE = 3;       // pixels a side of a coarse pixel has while the camera moves
constexpr std::uint32_t STILL_FRAMES = 2; // without motion, before the picture is made whole
constexpr glm::vec3 BACKGROUND(0.085f, 0.09f, 0.095f);
constexpr std::uint32_t SMALLEST_BORDERED = 16; // pixels; smaller cells would be nothing but border
constexpr std::uint32_t PLAIN_CELL = 0xff585450, CELL_BORDER = 0xff201c1a, NO_CELL_COLOR = 0xff18171a;

std::uint32_t pack_hash_color(std::uint32_t id) {
    const glm::vec3 color = inspect::hash_color(id);
    return encode_srgb(color.r, 0) | encode_srgb(color.g, 0) << 8 | encode_srgb(color.b, 0) << 16 | 0xff000000u;
}

std::vector<std::uint32_t> mark_selected(const Workspace& workspace, std::uint64_t count) {
    std::vector<std::uint32_t> marks;
    if (!workspace.state.selection)
        return marks;
    marks.assign(count, 0);
    for (const std::uint32_t id : *workspace.state.selection)
        if (id < count)
            marks[id] = 1;
    return marks;
}

std::uint32_t dim(std::uint32_t color) {
    const std::uint32_t grey = ((color & 255) + (color >> 8 & 255) + (color >> 16 & 255)) / 6 + 20;
    return grey | grey << 8 | grey << 16 | 0xff000000u;
}

std::vector<std::uint32_t> paint(const inspect::CellImage& cells, std::span<const std::uint32_t> colors,
                                 std::span<const std::uint32_t> marks, bool hashes) {
    std::vector<std::uint32_t> pixels(cells.ids.size(), NO_CELL_COLOR);
    std::unordered_map<std::int32_t, std::uint32_t> sizes;
    for (const std::int32_t id : cells.ids)
        ++sizes[id];
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const std::int32_t id = cells.ids[i];
        if (id < 0)
            continue;
        const auto cell = static_cast<std::size_t>(id);
        std::uint32_t color = hashes                 ? pack_hash_color(static_cast<std::uint32_t>(id))
                              : cell < colors.size() ? colors[cell]
                                                     : PLAIN_CELL;
        if (cell < marks.size() && !marks[cell])
            color = dim(color);
        pixels[i] = cells.is_border[i] && sizes[id] >= SMALLEST_BORDERED ? CELL_BORDER : color;
    }
    return pixels;
}

// Whether the photons lack the colors that the mode shows them in.
bool find_what_is_missing(Workspace& workspace, Photons& photons, std::string& missing) {
    const ViewState& view = workspace.state.view;
    if (view.mode == ViewMode::map)
        workspace.seek_column(view.map_column, &missing, &photons);
    if (view.mode == ViewMode::colored_points && !photons.map.colors)
        missing = "the photons have no false colors; run a script that calls setPhotonColourEncoding";
    return !missing.empty();
}

} // namespace

bool shows_render(ViewMode mode) {
    return mode == ViewMode::render || mode == ViewMode::colored_render;
}

std::optional<inspect::SurfacePoint> ViewPicture::seek_surface(float x, float y) const {
    if (!m_surface || !(x >= 0 && x < 1 && y >= 0 && y < 1))
        return std::nullopt;
    return inspect::read_surface(*m_surface, static_cast<std::uint32_t>(x * static_cast<float>(m_surface->width)),
                                 static_cast<std::uint32_t>(y * static_cast<float>(m_surface->height)));
}

// The surfaces behind the photons; none without a scene.
void ViewPicture::see(Workspace& workspace, std::uint32_t width, std::uint32_t height) {
    const Scene* scene = workspace.results.scene.get();
    if (!scene || scene->triangles.empty()) {
        m_surface.reset();
        m_surface_key.clear();
        return;
    }
    const CameraPose pose = find_pose(workspace.state.view.camera);
    const std::string key = scene->hash + write_pose(pose) + write_values(width, height);
    if (m_surface && m_surface_key == key)
        return;
    // Photons are seen through glass: it is what they came through.
    m_surface = inspect::see_surfaces(workspace.device, *scene, *workspace.bench.find_buffers(*scene),
                                      frame_camera(scene->origin, pose, width, height), {width, height, true});
    m_surface_key = key;
}

void ViewPicture::draw_points(Workspace& workspace, Photons& photons, std::uint32_t width, std::uint32_t height) {
    const ViewState& view = workspace.state.view;
    const std::array<double, 3> origin = m_surface ? m_surface->origin : photons.map.origin;
    const inspect::SplatView seen{width, height, frame_camera(origin, find_pose(view.camera), width, height), origin,
                                  m_surface ? &*m_surface : nullptr};
    const bool is_colored = view.mode != ViewMode::points;
    const std::string source = view.mode == ViewMode::map ? view.map_column : "encoding";
    inspect::SplatStyle style;
    style.background = BACKGROUND;
    style.radius = 0.5f * view.point_size * workspace.scale * static_cast<float>(width) /
                   static_cast<float>(std::max(m_full_width, 1u));
    style.strength = (is_colored ? 1.2f : 0.35f) * std::exp2(view.brightness);
    const std::vector<std::uint32_t> marks = mark_selected(workspace, photons.map.count);
    static const std::vector<std::uint32_t> none;
    const std::vector<std::uint32_t>& colors = is_colored ? workspace.find_colors(source, &photons) : none;
    m_pixels = inspect::splat_photons(workspace.device, photons.map, seen, colors, marks, style);
    workspace.pixels.set(m_texture, width, height, m_pixels);
}

void ViewPicture::draw_cells(Workspace& workspace, Photons& photons, std::string& missing) {
    if (!m_surface) {
        missing = "cells lie on surfaces: open the scene the photons were traced in";
        return;
    }
    const ViewState& view = workspace.state.view;
    const std::shared_ptr<const KdTree> tree = find_tree(workspace.device, photons);
    const bool is_tree = view.mode == ViewMode::kd_tree;
    const std::optional<std::uint32_t> depth =
        view.tree_depth < 0 ? std::nullopt : std::optional(static_cast<std::uint32_t>(view.tree_depth));
    const inspect::CellImage cells =
        is_tree ? inspect::find_kd_cells(workspace.device, photons.map, *tree, *m_surface, depth)
                : inspect::find_voronoi_cells(workspace.device, photons.map, *tree, *m_surface);
    const std::vector<std::uint32_t> marks =
        is_tree ? std::vector<std::uint32_t>{} : mark_selected(workspace, photons.map.count);
    workspace.pixels.set(m_texture, cells.width, cells.height,
                         paint(cells, workspace.find_colors("encoding", &photons), marks, is_tree));
}

void ViewPicture::draw_render(Workspace& workspace, std::string& missing) {
    const bool is_colored = workspace.state.view.mode == ViewMode::colored_render;
    const std::optional<Image>& image = is_colored ? workspace.results.colors : workspace.results.image;
    if (!image) {
        missing = is_colored && !workspace.results.photons->map.colors
                      ? "the photons have no false colors; run a script that calls setPhotonColourEncoding"
                      : workspace.explain_wait("render", "the image is being rendered");
        return;
    }
    workspace.pixels.set(m_texture, image->width, image->height, map_tones(*image, workspace.state.image));
}

void ViewPicture::update(Workspace& workspace, bool relaxed, std::uint32_t width, std::uint32_t height,
                         std::string& missing) {
    Photons* photons = workspace.shown(relaxed);
    if (!photons) {
        missing = "there are no photons yet: drop a scene or a photon map here, or open one in the status line";
        return;
    }
    const StudioState& state = workspace.state;
    const std::string camera = write_pose(find_pose(state.view.camera));
    const bool moves = !workspace.is_offscreen && camera != m_last_camera && !m_last_camera.empty();
    m_still_frames = moves ? 0 : m_still_frames + 1;
    m_last_camera = camera;
    const bool is_coarse = !workspace.is_offscreen && m_still_frames < STILL_FRAMES;
    workspace.is_settled &= !is_coarse;
    m_full_width = width;
    const std::uint32_t share = is_coarse ? COARSE : 1;
    const std::uint32_t columns = std::max(width / share, 1u), rows = std::max(height / share, 1u);
    const std::string key =
        camera + write_values(columns, rows, static_cast<int>(state.view.mode), relaxed,
                              workspace.results.photons_version, workspace.selection_version, state.view.map_column,
                              state.view.point_size, state.view.brightness, state.view.tree_depth,
                              workspace.results.image_version, state.image.tone, state.image.exposure);
    missing = m_missing;
    if (key == m_key)
        return;
    missing.clear();
    try {
        see(workspace, columns, rows);
        switch (state.view.mode) {
        case ViewMode::voronoi:
        case ViewMode::kd_tree:
            draw_cells(workspace, *photons, missing);
            break;
        case ViewMode::render:
        case ViewMode::colored_render:
            draw_render(workspace, missing);
            break;
        default:
            if (find_what_is_missing(workspace, *photons, missing))
                break;
            draw_points(workspace, *photons, columns, rows);
        }
    } catch (const Error& error) {
        missing = error.what();
    }
    m_missing = missing;
    m_key = key;
}

} // namespace photonloupe::studio
