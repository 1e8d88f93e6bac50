// SPDX-License-Identifier: Apache-2.0
// Refusals of documents: versions, extensions, node graphs; and what is listed as ignored.
#include "scene/gltf_builder.h"

#include <gtest/gtest.h>

namespace photonloupe::test {
namespace {

Json make_document() {
    return make_triangle().finish();
}

std::string refuse_edit(const char* pointer, const Json& value) {
    Json document = make_document();
    document[Json::json_pointer(pointer)] = value;
    return find_refusal(document);
}

TEST(gltf_wall, other_versions_are_refused) {
    EXPECT_CONTAINS(refuse_edit("/asset/version", "3.0"), "test.gltf: /asset/version: glTF version \"3.0\"");
    EXPECT_CONTAINS(refuse_edit("/asset/minVersion", "2.1"), "it needs glTF \"2.1\"");
    EXPECT_EQ(refuse_edit("/asset/version", "2.1"), "");
    EXPECT_CONTAINS(find_text_refusal("{}"), "\"asset\" is missing");
}

TEST(gltf_wall, files_of_gltf_1_are_told_what_converts_them) {
    EXPECT_CONTAINS(refuse_edit("/asset/version", "1.0"),
                    "glTF version \"1.0\"; only glTF 2 is read: convert it with npx");
    EXPECT_CONTAINS(find_text_refusal(R"({"asset":{}})"), "npx gltf-pipeline");
    EXPECT_CONTAINS(find_text_refusal(std::string("glTF\1\0\0\0\x14\0\0\0\0\0\0\0\0\0\0\0", 20)), "npx gltf-pipeline");
}

TEST(gltf_wall, required_extensions_of_looks_are_listed) {
    const Json names{
        "KHR_texture_basisu", "KHR_materials_unlit", "KHR_materials_variants", "KHR_materials_pbrSpecularGlossiness",
        "MSFT_texture_dds",   "EXT_texture_avif",    "EXT_lights_image_based"};
    Json document = make_document();
    document["extensionsRequired"] = names;
    const Scene scene = load_document(document);
    for (const Json& name : names)
        EXPECT_TRUE(contains(scene.report.ignored, "extension " + name.dump() + ": not modeled")) << name;
}

TEST(gltf_wall, unknown_required_extensions_are_refused_by_name) {
    EXPECT_CONTAINS(refuse_edit("/extensionsRequired", Json::array({"EXT_voxels"})),
                    "the required extension \"EXT_voxels\" is not supported");
    EXPECT_EQ(refuse_edit("/extensionsRequired",
                          Json::array({"KHR_lights_punctual", "KHR_materials_transmission", "KHR_materials_volume",
                                       "KHR_materials_ior", "KHR_materials_emissive_strength"})),
              "");
}

TEST(gltf_wall, a_node_that_is_its_own_ancestor_is_refused) {
    EXPECT_CONTAINS(refuse_edit("/nodes/0/children", Json::array({0})), "/nodes/0: it is its own ancestor");
    EXPECT_CONTAINS(refuse_edit("/nodes", Json::parse(R"([{"children":[1]},{"children":[2]},{"children":[0]}])")),
                    "it is its own ancestor");
}

TEST(gltf_wall, a_node_with_two_parents_is_refused) {
    EXPECT_CONTAINS(refuse_edit("/nodes", Json::parse(R"([{"children":[2]},{"children":[2]},{}])")),
                    "/nodes/2: it is a child of node 0 and of node 1");
}

TEST(gltf_wall, a_node_that_a_scene_lists_again_is_drawn_once) {
    Json document = make_document();
    document["nodes"] = Json::parse(R"([{"mesh":0},{"children":[0],"translation":[5,0,0]}])");
    for (const char* nodes : {"[0,1]", "[1,0]", "[1,1]", "[1,0,1]"}) {
        document["scenes"] = Json::parse(std::string(R"([{"nodes":)") + nodes + "}]");
        const Scene scene = load_document(document);
        EXPECT_EQ(scene.triangles.size(), 1u) << nodes;
        EXPECT_EQ(scene.bounds.lo[0], 5) << nodes;
        EXPECT_TRUE(contains(scene.report.ignored, "are drawn once")) << nodes;
    }
    document["scenes"] = Json::parse(R"([{"nodes":[0]}])"); // its parent is not part of the scene
    EXPECT_EQ(load_document(document).bounds.lo[0], 0);
}

TEST(gltf_wall, nodes_nested_too_deep_are_refused) {
    Json nodes = Json::array();
    for (int i = 0; i < 256; ++i)
        nodes.push_back({{"children", {i + 1}}});
    nodes.push_back(Json::object());
    EXPECT_CONTAINS(refuse_edit("/nodes", nodes), "nodes are nested deeper than 256");
    nodes.erase(256);
    nodes[255].erase("children");
    EXPECT_EQ(refuse_edit("/nodes", nodes), "");
}

TEST(gltf_wall, broken_transforms_are_refused) {
    EXPECT_CONTAINS(refuse_edit("/nodes/0/scale", Json::array({1, 2})), "an array of 3 numbers was expected");
    EXPECT_CONTAINS(refuse_edit("/nodes/0/rotation", Json::array({0, 0, 0, 0})), "quaternion of length 0");
    EXPECT_CONTAINS(refuse_edit("/nodes/0/matrix", std::vector<int>(16, 1)), "not affine");
    Json document = make_document();
    document["nodes"][0] = Json::parse(R"({"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"scale":[1,1,1]})");
    EXPECT_CONTAINS(find_refusal(document), "both a matrix and a scale");
}

TEST(gltf_wall, too_many_images_are_refused) {
    EXPECT_CONTAINS(refuse_edit("/images", Json(std::vector<Json>(4097, Json::object()))), "at most 4096");
}

TEST(gltf_wall, material_factors_out_of_range_are_refused) {
    const auto refuse_material = [](const char* material) {
        return refuse_edit("/materials", Json::array({Json::parse(material)}));
    };
    EXPECT_CONTAINS(refuse_material(R"({"pbrMetallicRoughness":{"metallicFactor":1.5}})"),
                    "/materials/0/pbrMetallicRoughness/metallicFactor: 1.5 is outside 0.0 … 1.0");
    EXPECT_CONTAINS(refuse_material(R"({"emissiveFactor":[0,-1,0]})"), "/materials/0/emissiveFactor/1");
    EXPECT_CONTAINS(refuse_material(R"({"extensions":{"KHR_materials_ior":{"ior":0.5}}})"), "0.5 is outside 1.0");
    EXPECT_EQ(refuse_material(R"({"extensions":{"KHR_materials_ior":{"ior":0}}})"), "");
    EXPECT_CONTAINS(refuse_material(R"({"extensions":{"KHR_materials_volume":{"attenuationDistance":0}}})"),
                    "it must be more than 0");
    EXPECT_CONTAINS(refuse_material(R"({"extensions":{"KHR_materials_transmission":{"transmissionFactor":"1"}}})"),
                    "a number was expected");
}

TEST(gltf_wall, lights_and_cameras_out_of_range_are_refused) {
    const auto refuse_light = [](const char* light) {
        return refuse_edit("/extensions/KHR_lights_punctual/lights", Json::array({Json::parse(light)}));
    };
    EXPECT_CONTAINS(refuse_light(R"({"type":"point","intensity":-1})"), "intensity: -1.0 is outside");
    EXPECT_CONTAINS(refuse_light(R"({"type":"point","intensity":1e30,"color":[2,1,1]})"), "beyond the range");
    EXPECT_CONTAINS(refuse_light(R"({"type":"area"})"), "\"area\" is no kind of light");
    const auto refuse_camera = [](const char* camera) {
        return refuse_edit("/cameras", Json::array({Json::parse(camera)}));
    };
    EXPECT_CONTAINS(refuse_camera(R"({"type":"perspective"})"), "\"perspective\" is missing");
    EXPECT_CONTAINS(refuse_camera(R"({"type":"perspective","perspective":{"yfov":0,"znear":1}})"), "more than 0");
    EXPECT_CONTAINS(refuse_camera(R"({"type":"perspective","perspective":{"yfov":4,"znear":1}})"), "4.0 is outside");
}

TEST(gltf_wall, text_from_the_file_is_quoted_without_control_characters_and_shortened) {
    const std::string name = "\x1b[31m" + std::string(1000, 'x');
    const std::string message = refuse_edit("/extensionsRequired", Json::array({name}));
    EXPECT_EQ(message.find('\x1b'), std::string::npos);
    EXPECT_LT(message.size(), 300u);
}

TEST(gltf_wall, features_that_are_not_modeled_are_listed_by_name) {
    Json document = make_document();
    document["images"] = document["textures"] = document["animations"] = Json::array({Json::object()});
    document["extensionsUsed"] = Json::array({"KHR_materials_sheen"});
    document["meshes"][0]["primitives"].push_back({{"mode", 1}, {"attributes", {{"POSITION", 0}}}});
    document["materials"] = Json::parse(R"([{"alphaMode":"BLEND","normalTexture":{"index":0,
        "extensions":{"KHR_texture_transform":{}}}}])");
    document["cameras"] =
        Json::parse(R"([{"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"znear":0,"zfar":1}}])");
    document["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::parse(R"([{"type":"spot","spot":{}},{"type":"directional"},{"type":"point","range":3}])");
    document["scenes"] = Json::parse(R"([{"nodes":[0]},{"nodes":[]}])");
    document["scene"] = 0;
    const Scene scene = load_document(document);
    for (const char* feature : {"animations: everything is at rest", "KHR_materials_sheen",
                                "/materials/0/normalTexture: its texture has no PNG", "points and lines",
                                "orthographic cameras", "range of lights", "only the default scene 0 of 2"})
        EXPECT_TRUE(contains(scene.report.ignored, feature)) << feature;
}

} // namespace
} // namespace photonloupe::test
