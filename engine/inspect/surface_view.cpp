// SPDX-License-Identifier: Apache-2.0
// Sends a ray through every pixel, in chunks.
#include "inspect/surface_view.h"

#include <bit>
#include <cmath>

#include "gpu/commands.h"
#include "image/image.h"

namespace photonloupe::inspect {

SurfaceView see_surfaces(gpu::Device& device, const Scene& scene, const SceneBuffers& buffers,
                         const shared::CameraFrame& camera, const SurfaceViewSettings& settings,
                         const Progress& progress) {
    check_image_size(settings.width, settings.height, "surfaces seen");
    SurfaceView view{settings.width, settings.height, camera, scene.origin, {}, {}};
    view.points = gpu::Buffer(device, view.pixel_count() * sizeof(glm::vec4), "surfaces seen");
    view.normals = gpu::Buffer(device, view.pixel_count() * sizeof(glm::vec4), "surfaces seen");
    shared::SurfaceSettings push{camera, 0, 0, settings.width, settings.height, settings.sees_through ? 1u : 0u};
    gpu::dispatch_in_chunks(device, "see surfaces", {"inspect/see_surfaces.comp", 64, list_scene_defines(scene), {}},
                            buffers.bind({{"surface_points", view.points}, {"surface_normals", view.normals}}), push,
                            view.pixel_count(), 4096, progress);
    return view;
}

std::optional<SurfacePoint> read_surface(const SurfaceView& view, std::uint32_t column, std::uint32_t row) {
    if (column >= view.width || row >= view.height)
        return std::nullopt;
    const std::uint64_t pixel = std::uint64_t{row} * view.width + column;
    const glm::vec4 point = view.points.read<glm::vec4>(1, pixel)[0];
    if (!std::isfinite(point.w))
        return std::nullopt;
    const glm::vec4 normal = view.normals.read<glm::vec4>(1, pixel)[0];
    SurfacePoint seen{{}, glm::vec3(normal), std::bit_cast<std::int32_t>(normal.w), point.w};
    for (int axis = 0; axis < 3; ++axis)
        seen.position[axis] = static_cast<double>(point[axis]) + view.origin[axis];
    return seen;
}

} // namespace photonloupe::inspect
