// SPDX-License-Identifier: Apache-2.0
// Prepares the photons in media for beams and lets each beam walk through their tree, in as many turns as it takes.
#include "estimate/eye_beams.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "photons/gather.h"

namespace photonloupe {
namespace {

constexpr const char* STAGE = "gather in media";
// Beams of one dispatch at first.
constexpr std::uint64_t FIRST_BEAMS = 1 << 12;
// Photons at one place: each still covers some, as a share of the largest coordinate.
constexpr float LEAST_RADIUS = 1e-5f;

std::vector<glm::vec4> list_scattered(const Scene& scene, const MediaPhotons& photons) {
    const std::vector<glm::vec4> power = photons.map.power_object.read<glm::vec4>(photons.map.count);
    std::vector<glm::vec4> light;
    for (const glm::vec4& position : photons.tree.positions.read<glm::vec4>(photons.map.count)) {
        const glm::vec4& own = power[std::bit_cast<std::uint32_t>(position.w)];
        light.emplace_back(glm::vec3(own) * find_albedo(scene, std::bit_cast<std::uint32_t>(own.w)), own.w);
    }
    return light;
}

std::vector<float> find_photon_radii(gpu::Device& device, const MediaPhotons& photons, std::uint32_t k,
                                     const Progress& progress) {
    const gpu::Buffer found(device, photons.map.count * RADIUS_BYTES, "radii in media");
    find_radii(device, {photons.tree, Measure::world}, ask_photons(photons.tree), {rank_for(k)}, found, STAGE,
               progress);
    const shared::TreeNode root = photons.tree.nodes.read<shared::TreeNode>(1, 1)[0];
    float size = 0;
    for (int axis = 0; axis < 3; ++axis)
        size = std::max({size, std::abs(root.lo_split[axis]), std::abs(root.hi_axis[axis])});
    std::vector<float> radii;
    for (const glm::vec4& radius : found.read<glm::vec4>(photons.map.count))
        radii.push_back(std::max(std::sqrt(radius.x), std::max(LEAST_RADIUS * size, 1e-12f)));
    return radii;
}

// The largest radius below each node.
std::vector<float> find_reaches(const KdTree& tree, const std::vector<float>& radii) {
    const std::uint64_t leaves = std::uint64_t{1} << tree.leaf_level;
    std::vector<float> reaches(2 * leaves, 0.0f);
    for (std::uint64_t leaf = 0; leaf < leaves; ++leaf)
        for (std::uint32_t i = find_first_position(tree.count, leaf, tree.leaf_level);
             i < find_first_position(tree.count, leaf + 1, tree.leaf_level); ++i)
            reaches[leaves + leaf] = std::max(reaches[leaves + leaf], radii[i]);
    for (std::uint64_t node = leaves - 1; node > 0; --node)
        reaches[node] = std::max(reaches[2 * node], reaches[2 * node + 1]);
    return reaches;
}

} // namespace

EyeBeams allocate_beams(gpu::Device& device, std::uint64_t count) {
    const std::uint64_t bytes = std::max<std::uint64_t>(1, count) * sizeof(glm::vec4);
    return {count,
            gpu::Buffer(device, bytes, "eye paths in media"),
            gpu::Buffer(device, bytes, "eye paths in media"),
            gpu::Buffer(device, bytes, "eye paths in media"),
            gpu::Buffer(device, bytes, "light from media"),
            gpu::Buffer(device, std::max<std::uint64_t>(1, count) * sizeof(std::uint32_t), "eye paths in media")};
}

MediaLight prepare_media_light(gpu::Device& device, const Scene& scene, const PhotonMap& map, std::uint32_t k,
                               const Progress& progress) {
    MediaLight light;
    light.photons = take_media_photons(device, map, progress);
    if (light.photons.map.count == 0)
        return light;
    const std::vector<float> radii = find_photon_radii(device, light.photons, k, progress);
    light.light = gpu::make_buffer(device, list_scattered(scene, light.photons), "light from media");
    light.radii = gpu::make_buffer(device, radii, "radii in media");
    light.reaches = gpu::make_buffer(device, find_reaches(light.photons.tree, radii), "reaches in media");
    return light;
}

gpu::KernelSource name_beam_kernel(const Scene& scene) {
    return {"estimate/gather_beams.comp", 64, list_scene_defines(scene), {}};
}

void gather_beams(gpu::Device& device, const Scene& scene, const SceneBuffers& buffers, const MediaLight& light,
                  const EyeBeams& beams, std::uint64_t count, const Progress& progress) {
    gpu::fill(device, STAGE, beams.radiance, 0);
    if (light.photons.map.count == 0)
        return;
    gpu::fill(device, STAGE, beams.cursor, 1); // the root
    const shared::BeamSettings push{0, 0, static_cast<std::uint32_t>(light.photons.map.count),
                                    light.photons.tree.leaf_level};
    const std::vector<gpu::Binding> bindings = buffers.bind({{"tree_nodes", light.photons.tree.nodes},
                                                             {"tree_positions", light.photons.tree.positions},
                                                             {"tree_normals", light.photons.tree.normals},
                                                             {"photon_light", light.light},
                                                             {"photon_radii", light.radii},
                                                             {"node_reaches", light.reaches},
                                                             {"beam_origin", beams.origin},
                                                             {"beam_direction", beams.direction},
                                                             {"beam_cursor", beams.cursor},
                                                             {"beam_radiance", beams.radiance}});
    bool is_done = false;
    while (!is_done) {
        gpu::dispatch_in_chunks(device, STAGE, name_beam_kernel(scene), bindings, push, count, FIRST_BEAMS, progress);
        const std::vector<std::uint32_t> cursors = beams.cursor.read<std::uint32_t>(count);
        is_done = std::all_of(cursors.begin(), cursors.end(), [](std::uint32_t cursor) { return cursor == 0; });
    }
}

} // namespace photonloupe
