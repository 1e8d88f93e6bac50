// SPDX-License-Identifier: Apache-2.0
// Axes of parallel coordinates as the state has them: how they are changed, fitted and brushed.
#pragma once

#include "inspect/parallel_axes.h"
#include "studio/edit_state.h"

namespace photonloupe::studio {

// How engine/inspect shows an axis over one of its columns; without limits over the column's range.
inspect::Axis make_plot_axis(const AxisState& state, const std::vector<inspect::Column>& columns, std::size_t index);

// A command over the axes shown: while nobody chose any they follow the photons, the first change makes them the
// user's.
template <class Change>
void change_axes(Workspace& workspace, const char* name, const Change& make) {
    const std::vector<AxisState> axes = list_axes(workspace);
    workspace.change(name, [&](StudioState& state) {
        state.parallel.axes = axes;
        make(state.parallel.axes);
    });
}

// Zooms to the values of the photons that the plot shows.
void fit_axis(Workspace& workspace, AxisState& axis);

// The photons that all brushed axes choose, among those the plot shows; null without brushes.
Ids find_brushed(Workspace& workspace);

} // namespace photonloupe::studio
