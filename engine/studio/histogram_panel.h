// SPDX-License-Identifier: Apache-2.0
// Histograms ([SJL15] figures 8 f, g): any column, or what the script counted, with the share below and a threshold.
#pragma once

#include "inspect/histogram.h"
#include "studio/workspace.h"

namespace photonloupe::studio {

class HistogramPanel {
public:
    void draw(Workspace& workspace);

private:
    void draw_toolbar(Workspace& workspace);
    void update(Workspace& workspace);
    void count_selected(const Workspace& workspace);
    void draw_plot(Workspace& workspace);

    std::string m_key;
    std::string m_missing;
    std::string m_label;
    inspect::ColumnHistogram m_counted;
    std::vector<double> m_selected; // by bin; empty: nothing is selected
    std::uint64_t m_selected_version = 0;
    std::string m_selected_key;
    std::vector<float> m_values; // of the column; empty for what a script counted
};

} // namespace photonloupe::studio
