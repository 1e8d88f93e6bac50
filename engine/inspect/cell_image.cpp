// SPDX-License-Identifier: Apache-2.0
// Borders and colors of cells, on the host.
#include "inspect/cell_image.h"

#include "photons/photon_map.h"

namespace photonloupe::inspect {

CellImage make_cell_image(const SurfaceView& view) {
    CellImage image{view.width, view.height, {}, {}, {}};
    image.ids.assign(view.pixel_count(), -1);
    image.is_border.assign(view.pixel_count(), 0);
    image.depth.reserve(view.pixel_count());
    for (const glm::vec4& point : view.points.read<glm::vec4>(view.pixel_count()))
        image.depth.push_back(point.w);
    return image;
}

shared::CellSettings make_cell_settings(const PhotonMap& photons, const KdTree& tree, const SurfaceView& view) {
    shared::CellSettings settings{};
    for (int axis = 0; axis < 3; ++axis)
        settings.shift[axis] = static_cast<float>(view.origin[axis] - photons.origin[axis]);
    settings.photon_count = static_cast<std::uint32_t>(tree.count);
    settings.leaf_level = tree.leaf_level;
    return settings;
}

void find_borders(CellImage& image) {
    image.is_border.assign(image.ids.size(), 0);
    for (std::size_t row = 0; row < image.height; ++row)
        for (std::size_t column = 0; column < image.width; ++column) {
            const std::size_t at = row * image.width + column;
            const bool differs_right = column + 1 < image.width && image.ids[at] != image.ids[at + 1];
            const bool differs_below = row + 1 < image.height && image.ids[at] != image.ids[at + image.width];
            image.is_border[at] = differs_right || differs_below;
        }
}

namespace {

std::vector<std::uint32_t> count_pixels(const CellImage& image, std::size_t cell_count) {
    std::vector<std::uint32_t> counts(cell_count);
    for (const std::int32_t id : image.ids)
        if (id >= 0 && static_cast<std::size_t>(id) < cell_count)
            ++counts[id];
    return counts;
}

} // namespace

Image paint_cells(const CellImage& image, std::span<const glm::vec3> colors) {
    Image painted{image.width, image.height, {}, {}};
    painted.rgb.reserve(3 * image.ids.size());
    const std::vector<std::uint32_t> sizes = count_pixels(image, colors.size());
    for (std::size_t at = 0; at < image.ids.size(); ++at) {
        const std::int32_t id = image.ids[at];
        const bool has_cell = id >= 0 && static_cast<std::size_t>(id) < colors.size();
        const bool is_border = has_cell && sizes[id] >= LEAST_BORDERED && image.is_border[at] != 0;
        const glm::vec3 color = has_cell && !is_border ? colors[id] : glm::vec3(0);
        painted.rgb.insert(painted.rgb.end(), {color.r, color.g, color.b});
    }
    return painted;
}

} // namespace photonloupe::inspect
