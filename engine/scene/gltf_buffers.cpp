// SPDX-License-Identifier: Apache-2.0
// Every buffer is bounded before it is read.
#include "scene/gltf_buffers.h"

#include <nlohmann/json.hpp>

#include "scene/gltf_container.h"
#include "scene/gltf_uri.h"
#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr const char* REMEDY = "repair the file or export it again";

std::vector<unsigned char> read_buffer(const JsonPlace& place, std::size_t index, const std::filesystem::path& folder,
                                       std::optional<std::span<const unsigned char>> binary_chunk,
                                       std::uint64_t budget) {
    const std::uint64_t length = read_unsigned(require_member(place, "byteLength"), MAX_BUFFER_BYTES);
    if (length == 0)
        refuse(place, "byteLength is 0", REMEDY);
    if (length > budget)
        refuse(place, "the buffers together exceed " + std::to_string(MAX_BUFFER_BYTES) + " bytes", "split the scene");
    const JsonPlace uri_place = find_member(place, "uri");
    const JsonPlace extension = find_member(find_member(place, "extensions"), "EXT_meshopt_compression");
    std::vector<unsigned char> bytes;
    if (uri_place.value) {
        const std::string uri = read_string(uri_place);
        if (auto data = decode_data_uri(uri, uri_place))
            bytes = std::move(*data);
        else
            bytes = read_file_bytes(resolve_uri(uri, folder, uri_place), length, MAX_BUFFER_BYTES, uri_place);
    } else if (index == 0 && binary_chunk) {
        bytes.assign(binary_chunk->begin(),
                     binary_chunk->begin() + std::min<std::uint64_t>(length, binary_chunk->size()));
    } else if (read_flag_or(find_member(extension, "fallback"), false)) {
        return {}; // for readers that can't decompress
    } else {
        refuse(place, "it has neither a uri nor a binary chunk", "only buffer 0 of a GLB may do without a uri");
    }
    if (bytes.size() < length)
        refuse(place,
               "byteLength is " + std::to_string(length) + ", but there are " + std::to_string(bytes.size()) + " bytes",
               REMEDY);
    bytes.resize(length);
    return bytes;
}

} // namespace

BufferBytes read_buffers(const JsonPlace& root, const std::filesystem::path& folder,
                         std::optional<std::span<const unsigned char>> binary_chunk) {
    const JsonPlace places = find_member(root, "buffers");
    const std::size_t count = count_elements(places, MAX_ENTRIES);
    BufferBytes buffers;
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < count; ++i) {
        buffers.push_back(read_buffer(get_element(places, i), i, folder, binary_chunk, MAX_BUFFER_BYTES - total));
        total += buffers.back().size();
    }
    return buffers;
}

} // namespace photonloupe
