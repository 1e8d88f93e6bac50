// SPDX-License-Identifier: Apache-2.0
// Builds and loads the tests' glTF documents.
#include "scene/gltf_builder.h"

#include <algorithm>

#include "core/error.h"

namespace photonloupe::test {

std::string encode_base64(const std::string& bytes) {
    constexpr std::string_view DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t j = i; j < i + 3; ++j)
            bits = bits << 8 | (j < bytes.size() ? static_cast<unsigned char>(bytes[j]) : 0);
        for (int shift = 18; shift >= 0; shift -= 6)
            text += DIGITS[bits >> shift & 63];
    }
    if (bytes.size() % 3 != 0)
        text.replace(text.size() - (3 - bytes.size() % 3), std::string::npos, 3 - bytes.size() % 3, '=');
    return text;
}

std::size_t GltfBuilder::add_accessor(std::string_view bytes, std::size_t count, const char* type, int component_type) {
    m_buffer.resize((m_buffer.size() + 3) / 4 * 4);
    Json& views = document["bufferViews"];
    document["accessors"].push_back(
        {{"bufferView", views.size()}, {"componentType", component_type}, {"count", count}, {"type", type}});
    views.push_back({{"buffer", 0}, {"byteOffset", m_buffer.size()}, {"byteLength", bytes.size()}});
    m_buffer += bytes;
    return document["accessors"].size() - 1;
}

std::size_t GltfBuilder::add_vectors(const Vectors& vectors) {
    return add_accessor({reinterpret_cast<const char*>(vectors.data()), vectors.size() * sizeof vectors[0]},
                        vectors.size(), "VEC3", 5126);
}

std::size_t GltfBuilder::add_object(Json primitive, Json node) {
    node["mesh"] = document["meshes"].size();
    document["meshes"].push_back({{"primitives", Json::array({std::move(primitive)})}});
    document["nodes"].push_back(std::move(node));
    return document["nodes"].size() - 1;
}

std::size_t GltfBuilder::add_triangles(const Vectors& corners, Json node) {
    const std::size_t positions = add_vectors(corners);
    return add_object({{"attributes", {{"POSITION", positions}}}}, std::move(node));
}

std::size_t GltfBuilder::add_material(Json material) {
    document["materials"].push_back(std::move(material));
    return document["materials"].size() - 1;
}

Json GltfBuilder::finish() const {
    Json whole = document;
    if (!m_buffer.empty())
        whole["buffers"] = Json::array({{{"byteLength", m_buffer.size()},
                                         {"uri", "data:application/octet-stream;base64," + encode_base64(m_buffer)}}});
    for (const Json& buffer : more_buffers)
        whole["buffers"].push_back(buffer);
    return whole;
}

GltfBuilder make_triangle() {
    GltfBuilder builder;
    builder.add_triangles(RIGHT_TRIANGLE);
    return builder;
}

Scene load_text(std::string_view text, const std::filesystem::path& folder) {
    return load_scene_from_memory({reinterpret_cast<const unsigned char*>(text.data()), text.size()}, folder,
                                  "test.gltf");
}

Scene load_document(const Json& document) {
    return load_text(document.dump());
}

Scene load(const GltfBuilder& builder) {
    return load_document(builder.finish());
}

std::string find_text_refusal(std::string_view text, const std::filesystem::path& folder) {
    try {
        load_text(text, folder);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

std::string find_refusal(const Json& document) {
    return find_text_refusal(document.dump());
}

std::string find_refusal(const GltfBuilder& builder) {
    return find_refusal(builder.finish());
}

bool contains(const std::vector<std::string>& lines, std::string_view part) {
    return std::any_of(lines.begin(), lines.end(),
                       [part](const std::string& line) { return line.find(part) != std::string::npos; });
}

} // namespace photonloupe::test
