// SPDX-License-Identifier: Apache-2.0
// The panels: what each remembers between frames, and the call that lays it out. One file per panel.
#pragma once

#include <memory>

#include "studio/workspace.h"

namespace photonloupe::studio {

// Names of the windows, as widgets and exports call them.
inline constexpr const char* PANEL_NAMES[] = {
    "Script", "View", "Loupe", "Parallel coordinates", "Parameter space", "Histogram", "Relaxation", "Image", "Status"};

// Throws Error naming them.
void require_panel(const std::string& name);

class ScriptPanel;
class ViewPanel;
class ParallelPanel;
class ScatterPanel;
class HistogramPanel;
class ImagePanel;

class Panels {
public:
    Panels();
    ~Panels();

    // All windows of one frame; `dock` is the dock space they begin in.
    void draw(Workspace& workspace);
    // Puts the windows into their places in a dock space.
    static void arrange(unsigned dock, float width, float height);

private:
    std::unique_ptr<ScriptPanel> m_script;
    std::unique_ptr<ViewPanel> m_view;
    std::unique_ptr<ParallelPanel> m_parallel;
    std::unique_ptr<ScatterPanel> m_scatter;
    std::unique_ptr<HistogramPanel> m_histogram;
    std::unique_ptr<ImagePanel> m_image;
};

// Panels that remember nothing.
void draw_loupe_panel(Workspace& workspace);
void draw_relax_panel(Workspace& workspace);
void draw_status_line(Workspace& workspace);
void draw_key_list(Workspace& workspace);

} // namespace photonloupe::studio
