// SPDX-License-Identifier: Apache-2.0
// Builds trees once, under the map's lock.
#include "photons/map_trees.h"

#include "photons/map_columns.h"

namespace photonloupe {
namespace {

std::shared_ptr<const ParameterRows> find_parameter_rows(gpu::Device& device, IndexedMap& photons) {
    if (!photons.trees.rows)
        photons.trees.rows = std::make_shared<const ParameterRows>(make_parameter_rows(device, photons.map));
    return photons.trees.rows;
}

} // namespace

std::shared_ptr<const KdTree> find_tree(gpu::Device& device, IndexedMap& photons, const Progress& progress) {
    const std::lock_guard lock(*photons.mutex);
    if (!photons.trees.positions)
        photons.trees.positions = std::make_shared<const KdTree>(build_tree(device, photons.map, progress));
    return photons.trees.positions;
}

std::shared_ptr<const ParameterTree> find_parameter_tree(gpu::Device& device, IndexedMap& photons,
                                                         const Progress& progress) {
    const std::lock_guard lock(*photons.mutex);
    if (!photons.trees.parameters)
        photons.trees.parameters = std::make_shared<const ParameterTree>(
            build_parameter_tree(device, photons.map, find_parameter_rows(device, photons), progress));
    return photons.trees.parameters;
}

std::shared_ptr<const ParameterTree> find_layered_tree(gpu::Device& device, IndexedMap& photons,
                                                       const Progress& progress, std::optional<LayerReach> reach) {
    const std::lock_guard lock(*photons.mutex);
    MapTrees& trees = photons.trees;
    if (trees.layered && (!reach || *reach == trees.layered_for))
        return trees.layered;
    const LayerReach suited = reach.value_or(LayerReach{});
    const float scale = choose_parameter_scale(device, *find_parameter_tree(device, photons, progress), suited.k,
                                               suited.beta, progress);
    trees.layered = std::make_shared<const ParameterTree>(
        build_layered_tree(device, photons.map, find_parameter_rows(device, photons), scale, progress));
    trees.layered_for = suited;
    return trees.layered;
}

void build_view_trees(gpu::Device& device, IndexedMap& photons, const Progress& progress) {
    find_tree(device, photons, progress);
    if (photons.map.parameters)
        find_layered_tree(device, photons, progress);
}

bool has_tree(const IndexedMap& photons) {
    const std::lock_guard lock(*photons.mutex);
    return photons.trees.positions != nullptr;
}

void take_parameters(IndexedMap& photons, std::optional<ParameterColumns> parameters) {
    photons.trees = {photons.trees.positions, {}, {}, {}, {}};
    photons.map.parameters = std::move(parameters);
}

void set_parameters(gpu::Device& device, IndexedMap& photons, std::vector<float> values,
                    std::vector<ParameterAxis> axes) {
    std::optional<ParameterColumns> parameters;
    if (!axes.empty())
        parameters = make_parameters(device, std::move(values), std::move(axes));
    const std::lock_guard lock(*photons.mutex);
    take_parameters(photons, std::move(parameters));
}

} // namespace photonloupe
