// SPDX-License-Identifier: Apache-2.0
// Drives the two kernels that draw photons as points.
#include "inspect/splat_photons.h"

#include <algorithm>

#include "gpu/commands.h"
#include "inspect/surface_view.h"

namespace photonloupe::inspect {
namespace {

constexpr std::uint64_t GRANULE = 4096;

// What is absent still has to be bound.
gpu::Buffer upload_or_empty(gpu::Device& device, std::span<const std::uint32_t> values, const char* purpose) {
    return gpu::make_buffer(
        device, values.empty() ? std::span<const std::uint32_t>(std::array<std::uint32_t, 4>{}) : values, purpose);
}

shared::SplatSettings describe_splats(const PhotonMap& photons, const SplatView& view, const SplatStyle& style) {
    shared::SplatSettings push{};
    push.camera = view.camera;
    for (int i = 0; i < 3; ++i)
        push.shift_radius[i] = static_cast<float>(photons.origin[i] - view.origin[i]);
    push.shift_radius.w = style.radius;
    push.width = view.width;
    push.height = view.height;
    push.has_surface = view.surface ? 1 : 0;
    push.unit = std::clamp(shared::SPLAT_UNIT * shared::SPLAT_MOST / static_cast<float>(photons.count + 1), 1.0f,
                           shared::SPLAT_UNIT);
    return push;
}

} // namespace

gpu::Buffer splat_photons(gpu::Device& device, const PhotonMap& photons, const SplatView& view,
                          std::span<const std::uint32_t> colors, std::span<const std::uint32_t> marks,
                          const SplatStyle& style, const Progress& progress) {
    const std::uint64_t pixel_count = std::uint64_t{view.width} * view.height;
    const gpu::Buffer color_buffer = upload_or_empty(device, colors, "point colors");
    const gpu::Buffer mark_buffer = upload_or_empty(device, marks, "point marks");
    const gpu::Buffer none(device, 16, "no surface");
    const gpu::Buffer& points = view.surface ? view.surface->points : none;
    const gpu::Buffer& normals = view.surface ? view.surface->normals : none;
    gpu::Buffer sums(device, pixel_count * shared::SPLAT_SUMS * sizeof(std::uint32_t), "point sums");
    gpu::fill(device, "draw points", sums, 0);
    shared::SplatSettings push = describe_splats(photons, view, style);
    push.has_marks = marks.empty() ? 0 : 1;
    push.has_colors = colors.empty() ? 0 : 1;
    gpu::dispatch_in_chunks(device, "draw points", {"inspect/splat_photons.comp", 64, {}, {}},
                            {{"position_emitter", photons.position_emitter},
                             {"colors", color_buffer},
                             {"marks", mark_buffer},
                             {"surface_points", points},
                             {"surface_normals", normals},
                             {"sums", sums}},
                            push, photons.count, GRANULE, progress);
    gpu::Buffer pixels(device, pixel_count * sizeof(std::uint32_t), "points");
    shared::ResolveSettings resolve{};
    resolve.eye = view.camera.position;
    resolve.background = glm::vec4(style.background, 1);
    resolve.plain = glm::vec4(style.plain, 1);
    resolve.has_marks = push.has_marks;
    resolve.has_colors = push.has_colors;
    resolve.has_surface = push.has_surface;
    resolve.unit = push.unit;
    resolve.strength = style.strength;
    gpu::dispatch_in_chunks(
        device, "draw points", {"inspect/resolve_splats.comp", 64, {}, {}},
        {{"sums", sums}, {"surface_points", points}, {"surface_normals", normals}, {"pixels", pixels}}, resolve,
        pixel_count, GRANULE, progress);
    return pixels;
}

} // namespace photonloupe::inspect
