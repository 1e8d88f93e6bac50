// SPDX-License-Identifier: Apache-2.0
// Changes axes and finds what their brushes choose.
#include "studio/edit_axes.h"

#include <algorithm>
#include <cmath>

namespace photonloupe::studio {

inspect::Axis make_plot_axis(const AxisState& state, const std::vector<inspect::Column>& columns, std::size_t index) {
    inspect::Axis axis = inspect::make_axis(columns, index);
    if (state.low != state.high) {
        axis.low = std::min(state.low, state.high);
        axis.high = std::max(state.low, state.high);
    }
    axis.is_flipped = state.is_flipped;
    axis.is_closed = state.is_closed;
    axis.periods = std::max(state.periods, 1u);
    for (const auto& [low, high] : state.brushes)
        axis.brushes.push_back({low, high});
    return axis;
}

void fit_axis(Workspace& workspace, AxisState& axis) {
    const inspect::Column* column = workspace.seek_column(axis.name);
    const Ids ids = workspace.find_source(workspace.state.parallel.source);
    if (!column || !ids)
        return;
    float low = INFINITY, high = -INFINITY;
    for (const std::uint32_t id : *ids)
        if (std::isfinite(column->values[id])) {
            low = std::min(low, column->values[id]);
            high = std::max(high, column->values[id]);
        }
    if (low < high) {
        axis.low = low;
        axis.high = high;
    }
}

Ids find_brushed(Workspace& workspace) {
    std::vector<inspect::Column> columns;
    std::vector<inspect::Axis> axes;
    for (const AxisState& axis : workspace.state.parallel.axes) {
        const inspect::Column* column = axis.brushes.empty() ? nullptr : workspace.seek_column(axis.name);
        if (!column)
            continue;
        columns.push_back(*column);
        axes.push_back(make_plot_axis(axis, columns, columns.size() - 1));
    }
    if (axes.empty())
        return nullptr;
    const std::string& source = workspace.state.parallel.source;
    // A brush over the selection itself would only ever shrink it.
    const Ids within = source == "loupe" ? workspace.find_source(source) : nullptr;
    return std::make_shared<const std::vector<std::uint32_t>>(
        inspect::select_brushed(axes, columns, within ? *within : inspect::Selection{}));
}

} // namespace photonloupe::studio
