// SPDX-License-Identifier: Apache-2.0
// The node graph: parents, cycles, depth, transforms, and how often it draws each mesh.
#include "scene/gltf_nodes.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "scene/gltf_skins.h"
#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr const char* REMEDY = "repair the file or export it again";

struct NodeLinks {
    std::vector<std::uint32_t> children;
    std::optional<std::uint32_t> parent;
    std::optional<std::uint32_t> mesh;
    std::uint64_t draw_count = 1; // of the mesh
};

std::vector<std::uint32_t> read_indices(const JsonPlace& array, std::size_t count) {
    std::vector<std::uint32_t> indices;
    for (std::size_t i = 0; i < count_elements(array, MAX_ENTRIES); ++i)
        indices.push_back(*read_index(get_element(array, i), count, "node"));
    return indices;
}

void check_matrix(const JsonPlace& place) {
    const std::vector<double> matrix = read_numbers_or(place, std::vector<double>(16));
    if (matrix[3] != 0 || matrix[7] != 0 || matrix[11] != 0 || matrix[15] != 1)
        refuse(place, "the matrix is not affine (its last row is not 0 0 0 1)", REMEDY);
}

void write_transform(const JsonPlace& node, Json& approved) {
    const JsonPlace matrix = find_member(node, "matrix");
    if (matrix.value) {
        for (const char* key : {"translation", "rotation", "scale"})
            if (find_member(node, key).value)
                refuse(node, std::string("it has both a matrix and a ") + key, "keep one of them");
        check_matrix(matrix);
        approved["matrix"] = *matrix.value;
        return;
    }
    const auto rotation = read_numbers_or(find_member(node, "rotation"), {0, 0, 0, 1});
    if (std::all_of(rotation.begin(), rotation.end(), [](double part) { return part == 0; }))
        refuse(find_member(node, "rotation"), "the rotation is a quaternion of length 0", REMEDY);
    approved["rotation"] = rotation;
    approved["translation"] = read_numbers_or(find_member(node, "translation"), {0, 0, 0});
    approved["scale"] = read_numbers_or(find_member(node, "scale"), {1, 1, 1});
}

// Returns how many instances the node has.
std::uint64_t check_instances(const JsonPlace& node, AccessorTable& accessors, Json& approved) {
    const JsonPlace extension = find_member(find_member(node, "extensions"), "EXT_mesh_gpu_instancing");
    if (!extension.value)
        return 1;
    const JsonPlace attributes = require_member(extension, "attributes");
    std::optional<std::uint64_t> count;
    for (const auto& [name, width] : INSTANCE_ATTRIBUTES) {
        const JsonPlace place = find_member(attributes, name);
        const auto index = read_index(place, accessors.get_count(), "accessor");
        if (!index)
            continue;
        const AccessorColumn& column = accessors.use(*index);
        if (column.width != width || column.component_type == COMPONENT_UNSIGNED_INT)
            refuse(place, "it must be VEC" + std::to_string(width) + " of floats or normalized integers", REMEDY);
        if (column.count != count.value_or(column.count))
            refuse(place, std::to_string(column.count) + " instances, but " + std::to_string(*count) + " before",
                   REMEDY);
        count = column.count;
        approved["extensions"]["EXT_mesh_gpu_instancing"][name] = *index;
    }
    return count.value_or(1);
}

NodeLinks check_node(const JsonPlace& node, std::size_t node_count, const NodeTargets& targets,
                     AccessorTable& accessors, Json& approved) {
    NodeLinks links;
    links.children = read_indices(find_member(node, "children"), node_count);
    links.mesh = read_index(find_member(node, "mesh"), targets.mesh_count, "mesh");
    approved = {{"name", read_string_or(find_member(node, "name"), "")}};
    write_transform(node, approved);
    if (!links.children.empty())
        approved["children"] = links.children;
    if (links.mesh) {
        approved["mesh"] = *links.mesh;
        links.draw_count = check_instances(node, accessors, approved);
        if (const JsonPlace weights = find_member(node, "weights"); weights.value)
            approved["weights"] = read_weights(weights);
        if (const auto skin = read_index(find_member(node, "skin"), targets.skin_count, "skin"))
            approved["skin"] = *skin;
    }
    if (const auto camera = read_index(find_member(node, "camera"), targets.camera_count, "camera"))
        approved["camera"] = *camera;
    const JsonPlace extension = find_member(find_member(node, "extensions"), "KHR_lights_punctual");
    if (extension.value) {
        const auto light = *read_index(require_member(extension, "light"), targets.light_count, "light");
        approved["extensions"]["KHR_lights_punctual"]["light"] = light;
    }
    return links;
}

void link_parents(const JsonPlace& nodes, std::vector<NodeLinks>& links) {
    for (std::uint32_t node = 0; node < links.size(); ++node)
        for (const std::uint32_t child : links[node].children) {
            if (links[child].parent)
                refuse(get_element(nodes, child),
                       "it is a child of node " + std::to_string(*links[child].parent) + " and of node " +
                           std::to_string(node),
                       "give every node one parent");
            links[child].parent = node;
        }
}

// Visits every tree from its root; nodes that are left over lie on a cycle.
void check_depth(const JsonPlace& nodes, const std::vector<NodeLinks>& links) {
    std::vector<std::size_t> depths(links.size(), 0); // 0: not visited
    std::vector<std::uint32_t> stack;
    for (std::uint32_t root = 0; root < links.size(); ++root) {
        if (links[root].parent)
            continue;
        stack.push_back(root);
        depths[root] = 1;
        while (!stack.empty()) {
            const std::uint32_t node = stack.back();
            stack.pop_back();
            if (depths[node] > MAX_NODE_DEPTH)
                refuse(get_element(nodes, node), "nodes are nested deeper than " + std::to_string(MAX_NODE_DEPTH),
                       "flatten the node tree");
            for (const std::uint32_t child : links[node].children) {
                depths[child] = depths[node] + 1;
                stack.push_back(child);
            }
        }
    }
    const auto unvisited = std::find(depths.begin(), depths.end(), 0);
    if (unvisited != depths.end())
        refuse(get_element(nodes, std::size_t(unvisited - depths.begin())), "it is its own ancestor",
               "break the cycle of nodes");
}

// What a scene lists, less what it lists again and what it reaches from another root.
std::vector<std::uint32_t> keep_outermost(const std::vector<std::uint32_t>& listed,
                                          const std::vector<NodeLinks>& links) {
    std::vector<bool> is_listed(links.size(), false), is_kept(links.size(), false);
    for (const std::uint32_t node : listed)
        is_listed[node] = true;
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t node : listed) {
        std::optional<std::uint32_t> ancestor = links[node].parent;
        while (ancestor && !is_listed[*ancestor])
            ancestor = links[*ancestor].parent;
        if (ancestor || is_kept[node])
            continue;
        is_kept[node] = true;
        kept.push_back(node);
    }
    return kept;
}

std::vector<std::uint32_t> find_roots(const JsonPlace& root, const std::vector<NodeLinks>& links,
                                      std::vector<std::string>& ignored) {
    const JsonPlace scenes = find_member(root, "scenes");
    const std::size_t scene_count = count_elements(scenes, MAX_ENTRIES);
    const auto default_scene = read_index(find_member(root, "scene"), scene_count, "scene");
    if (scene_count == 0) {
        std::vector<std::uint32_t> roots;
        for (std::uint32_t node = 0; node < links.size(); ++node)
            if (!links[node].parent)
                roots.push_back(node);
        return roots;
    }
    const std::uint32_t scene = default_scene.value_or(0);
    if (scene_count > 1)
        ignored.push_back(std::string("/scenes: only the ") + (default_scene ? "default" : "first") + " scene " +
                          std::to_string(scene) + " of " + std::to_string(scene_count) + " is read");
    const JsonPlace place = find_member(get_element(scenes, scene), "nodes");
    const std::vector<std::uint32_t> listed = read_indices(place, links.size());
    std::vector<std::uint32_t> roots = keep_outermost(listed, links);
    if (roots.size() < listed.size())
        ignored.push_back(place.path + ": nodes that are listed twice or are children of others (" +
                          std::to_string(listed.size() - roots.size()) + ") are drawn once");
    return roots;
}

std::vector<std::uint64_t> count_draws(const std::vector<NodeLinks>& links, std::size_t mesh_count,
                                       std::vector<std::uint32_t> stack) {
    std::vector<std::uint64_t> counts(mesh_count, 0);
    while (!stack.empty()) {
        const NodeLinks& node = links[stack.back()];
        stack.pop_back();
        stack.insert(stack.end(), node.children.begin(), node.children.end());
        if (node.mesh)
            counts[*node.mesh] += node.draw_count; // at most 2^18 nodes of 2^31 instances
    }
    return counts;
}

} // namespace

std::vector<std::uint64_t> check_nodes(const JsonPlace& root, const NodeTargets& targets, AccessorTable& accessors,
                                       Json& approved, std::vector<std::string>& ignored) {
    const JsonPlace nodes = find_member(root, "nodes");
    const std::size_t node_count = count_elements(nodes, MAX_ENTRIES);
    std::vector<NodeLinks> links;
    for (std::size_t i = 0; i < node_count; ++i) {
        approved["nodes"].emplace_back();
        links.push_back(check_node(get_element(nodes, i), node_count, targets, accessors, approved["nodes"].back()));
    }
    link_parents(nodes, links);
    check_depth(nodes, links);
    const std::vector<std::uint32_t> roots = find_roots(root, links, ignored);
    approved["scene"] = 0;
    approved["scenes"] = Json::array({{{"nodes", roots}}});
    return count_draws(links, targets.mesh_count, roots);
}

} // namespace photonloupe
