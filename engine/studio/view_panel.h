// SPDX-License-Identifier: Apache-2.0
// The view: photons on the scene, with camera, loupe, and before and after.
#pragma once

#include "studio/view_picture.h"

namespace photonloupe::studio {

// Where the picture stands in the window, pixels, and how it projects.
struct ViewFrame {
    float x = 0, y = 0, width = 0, height = 0;
    shared::CameraFrame camera{};
    std::array<double, 3> origin{}; // world place of the camera's (0, 0, 0)
};

// A world place as a pixel of the window, and its depth; behind the camera: depth ≤ 0.
glm::vec3 find_pixel(const ViewFrame& frame, const std::array<double, 3>& place);

// The loupe over the picture: circle, neighbours, basis, drift, paths, pins.
void draw_loupe(Workspace& workspace, const ViewFrame& frame);

class ViewPanel {
public:
    void draw(Workspace& workspace);

private:
    void draw_toolbar(Workspace& workspace);
    void draw_picture(Workspace& workspace);
    void draw_images(Workspace& workspace, const ViewFrame& frame);
    void take_mouse(Workspace& workspace, const ViewFrame& frame);
    void move_under_cursor(Workspace& workspace, const ViewFrame& frame, float x, float y);

    ViewPicture m_before{"view before"};
    ViewPicture m_after{"view after"};
    bool m_is_dragging = false;
    bool m_drags_split = false;
    float m_mouse_x = 0, m_mouse_y = 0; // where the loupe was moved last
};

} // namespace photonloupe::studio
