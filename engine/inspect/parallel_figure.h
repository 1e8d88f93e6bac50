// SPDX-License-Identifier: Apache-2.0
// Parallel coordinates in one call: which photons are in focus, their curves, densities and image.
#pragma once

#include <filesystem>
#include <string>

#include "inspect/parallel_density.h"
#include "inspect/parallel_plot.h"

namespace photonloupe::inspect {

struct FigureSettings {
    std::uint32_t width = 900, height = 360;
    LayoutMargins margins;
    float tension = 1; // 0: straight lines
    bool has_density = true;
    CurveStyle style;
};

struct ParallelFigure {
    std::vector<Axis> axes;
    AxisLayout layout;
    Curves context, selected;           // all but what is in focus; what is
    std::vector<glm::vec3> colors;      // by curve of `selected`, sRGB; empty: the style's, or a density
    std::vector<AxisDensity> densities; // of the selected, by axis; empty: none were asked for
    CurveStyle style;
    CurveImage image;
};

// What the curves in focus are colored by: a column, else colors by photon id (sRGB), else the style's one color.
struct CurveColors {
    const Column* column = nullptr;
    std::span<const glm::vec3> by_photon;
};

// In focus are the photons of `focus` (empty: all) that the brushes select. Throws Error where axes make no sense or
// have no room.
ParallelFigure make_parallel_figure(gpu::Device& device, std::span<const Column> columns, std::vector<Axis> axes,
                                    const Selection& focus, const CurveColors& colors,
                                    const FigureSettings& settings = {});

// How axes are drawn, sRGB in hexadecimal and pixels; the same in SVG and PNG.
struct FigureStyle {
    const char* axis_color = "#333333";
    const char* density_color = "#8c8c8c";
    const char* brush_color = "#d97706";
    float density_opacity = 0.45f;
    float brush_opacity = 0.55f;
    float density_width = 22;
    float brush_width = 4;
    float font_size = 12;
};

// What stands above and below an axis: its ends; on a closed one both below, where they meet.
struct LimitLabels {
    std::string above, below;
};

LimitLabels find_limit_labels(const Axis& axis);

// Short lines across an axis at its ends and quarters, on the side without density.
std::vector<std::array<glm::vec2, 2>> list_ticks(const Axis& axis, const AxisPlace& place);

// A file that stands alone: curves as paths, or the image of their density, with axes, limits, densities and brushes.
// Throws Error with the path and the system's reason; the old file stays then.
void write_parallel_svg(const std::filesystem::path& path, const ParallelFigure& figure,
                        std::span<const Column> columns);

} // namespace photonloupe::inspect
