// SPDX-License-Identifier: Apache-2.0
// Small glTF documents for tests: geometry goes into one embedded buffer, the rest is edited as JSON.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/gltf_load.h"

namespace photonloupe::test {

using Json = nlohmann::json;
using Vectors = std::vector<std::array<float, 3>>;

std::string encode_base64(const std::string& bytes);

class GltfBuilder {
public:
    // The document; edit it freely before `finish`.
    Json document{{"asset", {{"version", "2.0"}}}};
    Json more_buffers = Json::array(); // behind the embedded one

    // Each returns the new accessor's index.
    std::size_t add_vectors(const Vectors& vectors);
    // Elements of any kind, as the bytes of `numbers`.
    template <class Number>
    std::size_t add_numbers(const std::vector<Number>& numbers, std::size_t count, const char* type, int component) {
        return add_accessor({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)}, count,
                            type, component);
    }
    template <class Index>
    std::size_t add_indices(const std::vector<Index>& indices) {
        const int type = sizeof(Index) == 1 ? 5121 : sizeof(Index) == 2 ? 5123 : 5125;
        return add_accessor({reinterpret_cast<const char*>(indices.data()), indices.size() * sizeof(Index)},
                            indices.size(), "SCALAR", type);
    }
    // Appends a mesh of one primitive and a node that draws it; returns the node's index.
    std::size_t add_object(Json primitive, Json node = Json::object());
    // As above, unindexed triangles without normals.
    std::size_t add_triangles(const Vectors& corners, Json node = Json::object());
    std::size_t add_material(Json material);

    const std::string& get_buffer() const { return m_buffer; }
    std::string& get_buffer() { return m_buffer; }
    // The document with its buffer as a data URI.
    Json finish() const;

private:
    std::size_t add_accessor(std::string_view bytes, std::size_t count, const char* type, int component_type);

    std::string m_buffer;
};

// A right triangle in the plane z = 0, counter-clockwise seen from +z.
const Vectors RIGHT_TRIANGLE{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
// One triangle, one node.
GltfBuilder make_triangle();

Scene load_text(std::string_view text, const std::filesystem::path& folder = {});
Scene load_document(const Json& document);
Scene load(const GltfBuilder& builder);

// The refusal's message; empty if the document loads.
std::string find_text_refusal(std::string_view text, const std::filesystem::path& folder = {});
std::string find_refusal(const Json& document);
std::string find_refusal(const GltfBuilder& builder);

bool contains(const std::vector<std::string>& lines, std::string_view part);

} // namespace photonloupe::test

// Fails unless the message holds the part, and shows the message.
#define EXPECT_CONTAINS(message, part)                                                                                 \
    EXPECT_PRED2([](const std::string& text, const std::string& piece) { return text.find(piece) != text.npos; },      \
                 message, part)
