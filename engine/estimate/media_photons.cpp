// SPDX-License-Identifier: Apache-2.0
// Takes the photons in media from a map and asks them for fluence.
#include "estimate/media_photons.h"

#include <algorithm>
#include <bit>

#include <glm/geometric.hpp>

#include "photons/gather.h"
#include "photons/map_columns.h"
#include "photons/neighbor_queries.h"
#include "photons/select_photons.h"

namespace photonloupe {
namespace {

constexpr const char* STAGE = "estimate fluence";
constexpr std::uint32_t OBJECT_BITS = shared::NO_OBJECT; // an object's index is that wide

const shared::Material* find_inside(const Scene& scene, std::uint32_t object) {
    if (object >= scene.objects.size())
        return nullptr;
    const shared::Material& material = scene.materials[scene.objects[object].material];
    return is_solid(material) ? &material : nullptr;
}

// What each photon's stopped flux says of the light that passed it: flux over extinction.
gpu::Buffer divide_by_extinction(gpu::Device& device, const Scene& scene, const PhotonMap& map) {
    std::vector<glm::vec4> values = map.power_object.read<glm::vec4>(map.count);
    for (glm::vec4& value : values) {
        const glm::vec3 extinction = find_extinction(scene, std::bit_cast<std::uint32_t>(value.w) & OBJECT_BITS);
        for (int channel = 0; channel < 3; ++channel)
            value[channel] = extinction[channel] > 0 ? value[channel] / extinction[channel] : 0.0f;
    }
    return gpu::make_buffer(device, values, "fluence of photons");
}

} // namespace

std::vector<std::uint32_t> list_media_photons(const PhotonMap& map) {
    std::vector<std::uint32_t> ids;
    const std::vector<glm::vec4> normals = map.normal_index.read<glm::vec4>(map.count);
    for (std::size_t i = 0; i < normals.size(); ++i)
        if (glm::length(glm::vec3(normals[i])) < shared::SURFACE_NORMAL_LENGTH)
            ids.push_back(static_cast<std::uint32_t>(i));
    return ids;
}

MediaPhotons take_media_photons(gpu::Device& device, const PhotonMap& map, const Progress& progress) {
    PhotonMap columns = share_map(map);
    columns.paths.reset();
    columns.parameters.reset();
    MediaPhotons photons;
    photons.map = select_photons(device, columns, list_media_photons(map));
    if (photons.map.count > 0)
        photons.tree = build_tree(device, photons.map, progress);
    return photons;
}

glm::vec3 find_extinction(const Scene& scene, std::uint32_t object) {
    const shared::Material* material = find_inside(scene, object);
    return material ? glm::vec3(material->absorption_ior) + glm::vec3(material->medium) : glm::vec3(0.0f);
}

glm::vec3 find_albedo(const Scene& scene, std::uint32_t object) {
    const shared::Material* material = find_inside(scene, object);
    const glm::vec3 extinction = find_extinction(scene, object);
    glm::vec3 albedo(0.0f);
    for (int channel = 0; material && channel < 3; ++channel)
        albedo[channel] = extinction[channel] > 0 ? material->medium[channel] / extinction[channel] : 0.0f;
    return albedo;
}

gpu::Buffer estimate_fluence_at(gpu::Device& device, const Scene& scene, const MediaPhotons& photons,
                                std::span<const glm::vec4> points, std::uint32_t k, const Progress& progress) {
    require_k(k);
    gpu::Buffer fluence(device, std::max<std::uint64_t>(1, points.size()) * sizeof(glm::vec4), "fluence");
    if (photons.map.count == 0 || points.empty()) {
        gpu::fill(device, STAGE, fluence, 0);
        return fluence;
    }
    const std::vector<std::uint32_t> order = order_points(points);
    std::vector<glm::vec4> ordered(order.size());
    std::transform(order.begin(), order.end(), ordered.begin(), [&](std::uint32_t i) { return points[i]; });
    const gpu::Buffer places = gpu::make_buffer(device, ordered, "points");
    const gpu::Buffer rows = gpu::make_buffer(device, order, "points");
    const gpu::Buffer power = divide_by_extinction(device, scene, photons.map);
    const gpu::Buffer radii(device, order.size() * RADIUS_BYTES, "radii of estimates");
    const Neighborhood neighborhood{photons.tree, Measure::world};
    const Queries queries{order.size(), &places};
    RadiusSettings radius{k + 1}; // the photon behind the k-th gives the radius
    radius.cuts_ties = true;
    find_radii(device, neighborhood, queries, radius, radii, STAGE, progress);
    GatherKernel kernel{"estimate/estimate_irradiance.comp", {"CUT_TIES", "BY_ID", "KERNEL 0", "IN_SPACE"}, {}};
    for (const gpu::Binding& binding :
         {gpu::Binding{"radii", radii}, {"power_object", power}, {"result_rows", rows}, {"irradiance", fluence}})
        kernel.bindings.push_back(binding);
    gather(device, neighborhood, queries, kernel, make_gather_settings(neighborhood, radius.rank), STAGE, progress);
    return fluence;
}

} // namespace photonloupe
