// SPDX-License-Identifier: Apache-2.0
// Linear blend skinning, glTF 2.0, section 3.7.3, in double precision.
#include "scene/pose_meshes.h"

#include <algorithm>

namespace photonloupe {

std::vector<glm::dmat4> place_instances(const tinygltf::Node& node, const glm::dmat4& world,
                                        const std::vector<AccessorColumn>& columns) {
    const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
    if (extension == node.extensions.end())
        return {world};
    AccessorColumn none;
    none.count = 1;
    const auto find_column = [&](const char* name) {
        if (!extension->second.Has(name))
            return none;
        AccessorColumn column = columns.at(std::size_t(extension->second.Get(name).GetNumberAsInt()));
        column.is_normalized = true; // what integers there are for rotations
        return column;
    };
    const AccessorColumn translations = find_column("TRANSLATION"), rotations = find_column("ROTATION"),
                         scales = find_column("SCALE");
    std::vector<glm::dmat4> transforms(std::max({translations.count, rotations.count, scales.count}));
    for (std::size_t i = 0; i < transforms.size(); ++i) {
        glm::dvec3 translation(0.0), scale(1.0);
        glm::dvec4 rotation(0, 0, 0, 1);
        for (std::uint32_t part = 0; part < 4; ++part) {
            if (part < 3 && translations.bytes)
                translation[int(part)] = translations.read(i, part);
            if (part < 3 && scales.bytes)
                scale[int(part)] = scales.read(i, part);
            if (rotations.bytes)
                rotation[int(part)] = rotations.read(i, part);
        }
        transforms[i] = world * compose_transform(translation, rotation, scale);
    }
    return transforms;
}

std::vector<std::vector<glm::dmat4>> pose_joints(const tinygltf::Model& model,
                                                 const std::vector<AccessorColumn>& columns) {
    std::vector<std::vector<glm::dmat4>> posed(model.skins.size());
    if (posed.empty())
        return posed;
    const std::vector<glm::dmat4> nodes = find_node_transforms(model);
    for (std::size_t skin = 0; skin < posed.size(); ++skin) {
        const std::vector<int>& joints = model.skins[skin].joints;
        const int matrices = model.skins[skin].inverseBindMatrices;
        for (std::size_t joint = 0; joint < joints.size(); ++joint) {
            glm::dmat4 inverse_bind(1.0);
            for (std::uint32_t i = 0; i < 16 && matrices >= 0; ++i)
                inverse_bind[int(i / 4)][int(i % 4)] = columns.at(std::size_t(matrices)).read(joint, i);
            posed[skin].push_back(nodes.at(std::size_t(joints[joint])) * inverse_bind);
        }
    }
    return posed;
}

std::optional<glm::dmat4> blend_joints(const std::vector<glm::dmat4>& joints, const PrimitiveReader& reader,
                                       std::uint32_t vertex) {
    glm::dmat4 sum(0.0);
    double total = 0.0;
    for (const PrimitiveReader::Influence& influence : reader.read_influences(vertex)) {
        if (influence.weight == 0)
            continue;
        if (influence.joint >= joints.size())
            return std::nullopt;
        sum += influence.weight * joints[influence.joint];
        total += influence.weight;
    }
    if (total == 0) // exporters leave vertices out that nothing moves
        return joints.empty() ? std::nullopt : std::optional(joints[0]);
    return sum / total;
}

} // namespace photonloupe
