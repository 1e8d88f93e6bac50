// SPDX-License-Identifier: Apache-2.0
// Draws the curves of parallel coordinates on the device: few ones anti-aliased, each in its color; many as the density
// of curves, on a logarithmic scale. Axes, labels and brushes are drawn by whoever shows the image.
#pragma once

#include <span>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "gpu/buffer.h"
#include "inspect/parallel_curves.h"

namespace photonloupe::gpu {
class Device;
}

namespace photonloupe::inspect {

// Colors are sRGB, and so is the space they are blended in.
struct CurveStyle {
    glm::vec4 background{1, 1, 1, 1};              // premultiplied by its alpha; 0: the image is laid over something
    glm::vec3 selected_color{0.13f, 0.34f, 0.55f}; // where no color of its own is given
    glm::vec3 context_color{0.55f, 0.55f, 0.55f};
    float opacity = 0.75f;
    float context_opacity = 0.3f;
    float line_width = 1.3f;          // pixels
    std::uint32_t most_curves = 2000; // more of them are drawn as a density
};

// How counting is cut over the device; never changes a count. 0: as suits the device.
struct CountSplit {
    std::uint32_t part_size = 0;  // curves one invocation walks, at most LARGEST_PART
    std::uint32_t part_count = 0; // walked side by side
};

// How many curves cover each pixel: one is counted in every row that it passes in the pixel's column, where it ends
// and another gap begins under a closed axis once for either.
struct Coverage {
    gpu::Buffer counts;  // context and selection (uvec2), by row
    gpu::Buffer largest; // of either (2 uint)
};

Coverage count_coverage(gpu::Device& device, const AxisLayout& layout, const Curves& context, const Curves& selected,
                        const CountSplit& split = {});

// RGBA, a byte each, red first, rows from the top, premultiplied by alpha.
struct CurveImage {
    std::uint32_t width = 0, height = 0;
    gpu::Buffer pixels;
    bool is_density = false;
};

// `colors` by curve of `selected`, or empty. The context lies beneath.
CurveImage draw_curves(gpu::Device& device, const AxisLayout& layout, const Curves& context, const Curves& selected,
                       std::span<const glm::vec3> colors = {}, const CurveStyle& style = {});

std::vector<std::uint8_t> read_pixels(const CurveImage& image);

} // namespace photonloupe::inspect
