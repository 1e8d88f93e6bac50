// SPDX-License-Identifier: Apache-2.0
// What the view shows beneath the loupe: photons as points, cells, partition, or a render, made again only when
// something it depends on changed.
#pragma once

#include <optional>
#include <string>

#include "inspect/surface_view.h"
#include "studio/workspace.h"

namespace photonloupe::studio {

// One picture: traced photons, or relaxed ones.
class ViewPicture {
public:
    explicit ViewPicture(std::string texture) : m_texture(std::move(texture)) {}

    // Makes the picture of that size, coarser while the camera moves. `missing` says why there is none.
    void update(Workspace& workspace, bool relaxed, std::uint32_t width, std::uint32_t height, std::string& missing);
    std::uint64_t find_texture(const Workspace& workspace) const { return workspace.pixels.find(m_texture); }

    // What a place of the picture sees, shares of its width and height; nothing: no surface there.
    std::optional<inspect::SurfacePoint> seek_surface(float x, float y) const;
    bool has_surfaces() const { return m_surface.has_value(); }

private:
    void see(Workspace& workspace, std::uint32_t width, std::uint32_t height);
    void draw_points(Workspace& workspace, Photons& photons, std::uint32_t width, std::uint32_t height);
    void draw_cells(Workspace& workspace, Photons& photons, std::string& missing);
    void draw_render(Workspace& workspace, std::string& missing);

    std::string m_texture;
    std::string m_key; // of what is shown
    std::string m_surface_key;
    std::optional<inspect::SurfaceView> m_surface;
    gpu::Buffer m_pixels;
    std::string m_last_camera;
    std::string m_missing;
    std::uint32_t m_still_frames = 0;
    std::uint32_t m_full_width = 0; // of the picture once it is whole
};

// Whether the mode shows rendered images, whose aspect is their own.
bool shows_render(ViewMode mode);

} // namespace photonloupe::studio
