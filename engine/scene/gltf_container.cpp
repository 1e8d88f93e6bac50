// SPDX-License-Identifier: Apache-2.0
// Reads and takes apart .gltf and .glb files in checked arithmetic.
#include "scene/gltf_container.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <nlohmann/json.hpp>

#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr std::uint64_t GLB_HEADER_BYTES = 12;
constexpr std::uint64_t GLB_CHUNK_HEADER_BYTES = 8;
constexpr std::uint32_t GLB_VERSION = 2;
constexpr std::uint32_t GLB_CHUNK_JSON = 0x4E4F534A; // "JSON"
constexpr std::uint32_t GLB_CHUNK_BIN = 0x004E4942;  // "BIN"
constexpr const char* TRUNCATED_REMEDY = "the file is cut off or damaged: copy or export it again";

// GLB is little-endian on every machine.
std::uint32_t read_u32(std::span<const unsigned char> bytes, std::uint64_t offset) {
    const auto byte = [&](std::uint64_t i) { return std::uint32_t(bytes[offset + i]); };
    return byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
}

std::string_view view_text(std::span<const unsigned char> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

GltfContainer split_glb(std::span<const unsigned char> bytes, const JsonPlace& place) {
    if (bytes.size() < GLB_HEADER_BYTES + GLB_CHUNK_HEADER_BYTES)
        refuse(place, "a GLB of " + std::to_string(bytes.size()) + " bytes has no room for its header",
               TRUNCATED_REMEDY);
    if (const std::uint32_t version = read_u32(bytes, 4); version != GLB_VERSION)
        refuse(place, "GLB container version " + std::to_string(version),
               version == 1 ? GLTF_1_REMEDY : "only version 2 is read: export it again");
    const std::uint64_t length = read_u32(bytes, 8);
    if (length != bytes.size())
        refuse(place,
               "the GLB header says " + std::to_string(length) + " bytes, the file has " + std::to_string(bytes.size()),
               TRUNCATED_REMEDY);
    GltfContainer container;
    std::uint64_t offset = GLB_HEADER_BYTES;
    for (std::size_t chunk = 0; offset < length; ++chunk) {
        if (length - offset < GLB_CHUNK_HEADER_BYTES)
            refuse(place, "GLB chunk " + std::to_string(chunk) + " has no whole header", TRUNCATED_REMEDY);
        const std::uint64_t size = read_u32(bytes, offset);
        const std::uint32_t kind = read_u32(bytes, offset + 4);
        offset += GLB_CHUNK_HEADER_BYTES;
        if (size > length - offset)
            refuse(place,
                   "GLB chunk " + std::to_string(chunk) + " says " + std::to_string(size) + " bytes, " +
                       std::to_string(length - offset) + " are left",
                   TRUNCATED_REMEDY);
        const std::span<const unsigned char> content = bytes.subspan(offset, size);
        if (chunk == 0 && kind != GLB_CHUNK_JSON)
            refuse(place, "the GLB's first chunk is not JSON", "export it again");
        if (chunk == 0)
            container.json = view_text(content);
        else if (chunk == 1 && kind == GLB_CHUNK_BIN)
            container.binary_chunk = content;
        offset += size; // chunks of other kinds are skipped, as glTF 2.0 asks
    }
    return container;
}

bool looks_like_json(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF"))
        text.remove_prefix(3);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && text[first] == '{';
}

// Nesting of brackets outside strings. A text where this is wrong is no JSON and fails to parse.
std::size_t measure_nesting(std::string_view text) {
    std::size_t depth = 0, deepest = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            deepest = std::max(deepest, ++depth);
        } else if ((c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
    return deepest;
}

std::string locate_byte(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, std::min(byte > 0 ? byte - 1 : 0, text.size()));
    const std::size_t line = std::size_t(std::count(before.begin(), before.end(), '\n')) + 1;
    const std::size_t line_start = before.rfind('\n');
    const std::size_t column = before.size() - (line_start == std::string_view::npos ? 0 : line_start + 1) + 1;
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

} // namespace

JsonPlace find_extension(const JsonPlace& owner, const char* name) {
    return find_member(find_member(owner, "extensions"), name);
}

std::vector<unsigned char> read_file_bytes(const std::filesystem::path& path, std::optional<std::uint64_t> byte_count,
                                           std::uint64_t limit, const JsonPlace& place) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status))
        refuse(place, "the file " + quote_text(path.string()) + " does not exist", "check the name and its folder");
    if (!std::filesystem::is_regular_file(status)) // a pipe or a device could block or never end
        refuse(place, quote_text(path.string()) + " is not a regular file", "name a file");
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error)
        refuse(place, quote_text(path.string()) + ": " + error.message(), "check the file's permissions");
    const std::uint64_t wanted = byte_count.value_or(size);
    if (wanted > size)
        refuse(place,
               quote_text(path.string()) + " has " + std::to_string(size) + " bytes, " + std::to_string(wanted) +
                   " are needed",
               TRUNCATED_REMEDY);
    if (wanted > limit)
        refuse(place,
               quote_text(path.string()) + " has " + std::to_string(wanted) + " bytes, at most " +
                   std::to_string(limit) + " are read",
               "split the scene");
    std::vector<unsigned char> bytes(wanted);
    std::ifstream stream(path, std::ios::binary);
    stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(wanted));
    if (!stream)
        refuse(place, quote_text(path.string()) + " can't be read: " + std::strerror(errno),
               "check the file's permissions");
    return bytes;
}

GltfContainer split_container(std::span<const unsigned char> bytes, const JsonPlace& place) {
    const std::string_view text = view_text(bytes);
    if (text.starts_with("glTF"))
        return split_glb(bytes, place);
    if (!looks_like_json(text))
        refuse(place, "neither glTF text (JSON) nor a GLB", "give a .gltf or .glb file of glTF 2.0");
    return {text, std::nullopt};
}

Json parse_json(std::string_view text, const JsonPlace& place) {
    if (text.size() > MAX_JSON_BYTES)
        refuse(place,
               "its JSON has " + std::to_string(text.size()) + " bytes, at most " + std::to_string(MAX_JSON_BYTES) +
                   " are read",
               "move data: buffers into .bin files or split the scene");
    if (const std::size_t depth = measure_nesting(text); depth > MAX_JSON_DEPTH)
        refuse(place,
               "its JSON is nested " + std::to_string(depth) + " deep, at most " + std::to_string(MAX_JSON_DEPTH) +
                   " levels are read",
               "export it again without such extras");
    try {
        return Json::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        refuse(place, "its JSON can't be parsed at " + locate_byte(text, error.byte), "repair it there");
    } catch (const nlohmann::json::exception&) {
        refuse(place, "its JSON has a number beyond the range of doubles", "repair it");
    }
}

} // namespace photonloupe
