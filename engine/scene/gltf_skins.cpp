// SPDX-License-Identifier: Apache-2.0
// Skins: joints that are nodes, one matrix of floats for each.
#include "scene/gltf_skins.h"

#include <nlohmann/json.hpp>

#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr const char* REMEDY = "repair the file or export it again";
constexpr std::uint32_t MATRIX_COMPONENTS = 16;

Json check_skin(const JsonPlace& skin, std::size_t node_count, AccessorTable& accessors) {
    const JsonPlace joints = require_member(skin, "joints");
    Json approved{{"joints", Json::array()}};
    for (std::size_t i = 0; i < count_elements(joints, MAX_ENTRIES); ++i)
        approved["joints"].push_back(*read_index(get_element(joints, i), node_count, "node"));
    const JsonPlace matrices = find_member(skin, "inverseBindMatrices");
    if (const auto index = read_index(matrices, accessors.get_count(), "accessor")) {
        const AccessorColumn& column = accessors.use(*index);
        if (column.width != MATRIX_COMPONENTS || column.component_type != COMPONENT_FLOAT)
            refuse(matrices, "it must be MAT4 of floats", REMEDY);
        if (column.count < approved["joints"].size())
            refuse(matrices,
                   std::to_string(column.count) + " matrices for " + std::to_string(approved["joints"].size()) +
                       " joints",
                   REMEDY);
        approved["inverseBindMatrices"] = *index;
    }
    return approved;
}

} // namespace

void check_skins(const JsonPlace& root, AccessorTable& accessors, Json& approved) {
    const JsonPlace skins = find_member(root, "skins");
    const std::size_t count = count_elements(skins, MAX_ENTRIES);
    std::vector<bool> is_used(count, false);
    for (const Json& node : approved.value("nodes", Json::array()))
        if (const auto skin = node.find("skin"); skin != node.end())
            is_used[skin->get<std::size_t>()] = true;
    const std::size_t node_count = count_elements(find_member(root, "nodes"), MAX_ENTRIES);
    for (std::size_t i = 0; i < count; ++i)
        approved["skins"].push_back(is_used[i] ? check_skin(get_element(skins, i), node_count, accessors)
                                               : Json{{"joints", Json::array()}});
}

std::vector<double> read_weights(const JsonPlace& place) {
    std::vector<double> weights;
    for (std::size_t i = 0; i < count_elements(place, MAX_ENTRIES); ++i)
        weights.push_back(read_number(get_element(place, i)));
    return weights;
}

} // namespace photonloupe
