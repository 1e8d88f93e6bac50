// SPDX-License-Identifier: Apache-2.0
// Parameter space ([SJL15] figures 8 a–b, 9 f, 10): photons by any two columns, Cartesian or polar, with a lasso; or
// the loupe's photons in world and parameter space side by side.
#pragma once

#include <optional>
#include <vector>

#include "inspect/scatter.h"
#include "studio/workspace.h"

namespace photonloupe::studio {

class ScatterPanel {
public:
    void draw(Workspace& workspace);

private:
    struct Plot {
        std::string key;
        std::string missing;
        std::optional<inspect::ScatterFrame> frame;
        inspect::Column x, y;
        std::uint64_t drawn_count = 0;
    };
    void draw_toolbar(Workspace& workspace);
    void update(Workspace& workspace, Plot& plot, const std::string& texture, const std::string& x,
                const std::string& y, bool is_polar, std::uint32_t width, std::uint32_t height);
    void show(Workspace& workspace, const Plot& plot, const std::string& texture, float x, float y, float width,
              float height);
    void take_lasso(Workspace& workspace, const Plot& plot, float x, float y);

    Plot m_plot, m_world;
    std::vector<glm::vec2> m_lasso; // pixels of the plot
    bool m_is_lassoing = false;
};

} // namespace photonloupe::studio
