// SPDX-License-Identifier: Apache-2.0
// Parallel coordinates ([SJL15] figures 6 b, 7 h): the loupe's photons, all, or the selection, along axes that are
// dragged, closed, zoomed and brushed.
#pragma once

#include "inspect/parallel_density.h"
#include "inspect/parallel_plot.h"
#include "studio/workspace.h"

namespace photonloupe::studio {

class ParallelPanel {
public:
    void draw(Workspace& workspace);

private:
    // What is drawn now, and of which choices.
    struct Plot {
        std::string key;
        std::vector<std::string> names;  // of the axes shown
        std::vector<std::size_t> places; // of them among the state's axes
        std::vector<inspect::Column> columns;
        std::vector<inspect::Axis> axes;
        inspect::AxisLayout layout;
        std::vector<inspect::AxisDensity> densities;
        std::size_t curve_count = 0, selected_count = 0, broken_count = 0;
        std::string missing;
    };
    enum class Grip { none, brush, move, zoom };

    void draw_toolbar(Workspace& workspace);
    void update(Workspace& workspace, std::uint32_t width, std::uint32_t height);
    void find_axes(Workspace& workspace);
    void draw_curves(Workspace& workspace, const inspect::Selection& photons);
    void draw_axes(Workspace& workspace, float x, float y);
    void draw_axis_menu(Workspace& workspace);
    void take_mouse(Workspace& workspace, float x, float y);
    void grip_axis(float column, float row);
    void release_axis(Workspace& workspace, float column, float end);
    void brush(Workspace& workspace, float to);

    Plot m_plot;
    gpu::Buffer m_pixels;
    Grip m_grip = Grip::none;
    std::size_t m_axis = 0;   // the one held, or of the menu
    bool m_has_moved = false; // since the button went down
    bool m_is_new = false;    // the brush of this drag is not there yet
    bool m_adds = false;      // it leaves the axis' other brushes
    float m_scale = 1;
    float m_begin = 0; // value where the drag began
};

} // namespace photonloupe::studio
