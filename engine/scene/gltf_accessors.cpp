// SPDX-License-Identifier: Apache-2.0
// Checked arithmetic on buffers, views and accessors; all sums and products are of values below 2^32.
#include "scene/gltf_accessors.h"

#include <array>

#include <nlohmann/json.hpp>

#include "scene/gltf_container.h"
#include "scene/gltf_uri.h"
#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr const char* REMEDY = "repair the file or export it again";
// glTF 2.0, section 5.11: strides are multiples of 4 up to 252.
constexpr std::uint64_t MAX_STRIDE = 252;

struct BufferView {
    std::size_t buffer = 0;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
    std::uint64_t stride = 0; // 0: packed
};

struct ElementKind {
    const char* type;
    std::uint64_t columns;
    std::uint64_t rows;
};
constexpr std::array<ElementKind, 7> ELEMENT_KINDS{
    {{"SCALAR", 1, 1}, {"VEC2", 1, 2}, {"VEC3", 1, 3}, {"VEC4", 1, 4}, {"MAT2", 2, 2}, {"MAT3", 3, 3}, {"MAT4", 4, 4}}};

std::uint64_t measure_component(std::uint64_t component_type, const JsonPlace& place) {
    switch (component_type) {
    case COMPONENT_BYTE:
    case COMPONENT_UNSIGNED_BYTE:
        return 1;
    case COMPONENT_SHORT:
    case COMPONENT_UNSIGNED_SHORT:
        return 2;
    case COMPONENT_UNSIGNED_INT:
    case COMPONENT_FLOAT:
        return 4;
    default:
        refuse(place, "component type " + std::to_string(component_type) + " is none of glTF 2.0", REMEDY);
    }
}

// Columns of matrices start at multiples of 4 bytes.
std::uint64_t measure_element(const AccessorSpan& accessor, std::uint64_t component_bytes) {
    for (const ElementKind& kind : ELEMENT_KINDS)
        if (accessor.type == kind.type) {
            const std::uint64_t column = kind.rows * component_bytes;
            return kind.columns == 1 ? column : kind.columns * ((column + 3) / 4 * 4);
        }
    refuse(accessor.place, "type " + quote_text(accessor.type) + " is none of glTF 2.0", REMEDY);
}

BufferView check_view(const JsonPlace& root, std::uint32_t index, const BufferBytes& buffers) {
    const JsonPlace place = get_element(find_member(root, "bufferViews"), index);
    BufferView view;
    view.buffer = *read_index(require_member(place, "buffer"), buffers.size(), "buffer");
    const std::uint64_t available = buffers[view.buffer].size();
    view.offset = read_unsigned_or(find_member(place, "byteOffset"), MAX_BUFFER_BYTES, 0);
    view.length = read_unsigned(require_member(place, "byteLength"), MAX_BUFFER_BYTES);
    view.stride = read_unsigned_or(find_member(place, "byteStride"), MAX_STRIDE, 0);
    if (view.stride % 4 != 0)
        refuse(place, "byteStride " + std::to_string(view.stride) + " is no multiple of 4", REMEDY);
    if (view.length == 0)
        refuse(place, "byteLength is 0", REMEDY);
    if (view.offset + view.length > available)
        refuse(place,
               "it ends at byte " + std::to_string(view.offset + view.length) + " of buffer " +
                   std::to_string(view.buffer) + ", which has " + std::to_string(available),
               REMEDY);
    return view;
}

// Places `count` elements in a view; `offset` is inside the view.
void check_extent(const JsonPlace& place, const BufferView& view, std::uint64_t offset, std::uint64_t count,
                  std::uint64_t stride, std::uint64_t element_bytes, std::uint64_t component_bytes) {
    if (stride < element_bytes)
        refuse(place, "the view's byteStride " + std::to_string(stride) + " is shorter than an element", REMEDY);
    if ((view.offset + offset) % component_bytes != 0 || stride % component_bytes != 0)
        refuse(place, "its elements are not aligned to their component size", REMEDY);
    const std::uint64_t end = offset + (count - 1) * stride + element_bytes;
    if (end > view.length)
        refuse(place,
               "its " + std::to_string(count) + " elements end at byte " + std::to_string(end) +
                   " of a buffer view of " + std::to_string(view.length),
               REMEDY);
}

void check_sparse(const JsonPlace& root, const AccessorSpan& accessor, std::uint64_t element_bytes,
                  std::uint64_t component_bytes, const BufferBytes& buffers) {
    const JsonPlace sparse = find_member(accessor.place, "sparse");
    const std::size_t view_count = count_elements(find_member(root, "bufferViews"), MAX_ENTRIES);
    const std::uint64_t count = read_unsigned(require_member(sparse, "count"), accessor.count);
    if (count == 0)
        refuse(sparse, "count is 0", REMEDY);
    for (const char* part : {"indices", "values"}) {
        const JsonPlace place = require_member(sparse, part);
        const BufferView view =
            check_view(root, *read_index(require_member(place, "bufferView"), view_count, "buffer view"), buffers);
        const std::uint64_t offset = read_unsigned_or(find_member(place, "byteOffset"), MAX_BUFFER_BYTES, 0);
        std::uint64_t element = element_bytes, component = component_bytes;
        if (std::string_view(part) == "indices")
            element = component =
                measure_component(read_unsigned(require_member(place, "componentType"), COMPONENT_FLOAT), place);
        check_extent(place, view, offset, count, element, element, component);
    }
}

AccessorSpan check_accessor(const JsonPlace& root, const JsonPlace& place, std::size_t view_count,
                            const BufferBytes& buffers) {
    AccessorSpan accessor;
    accessor.place = place;
    accessor.type = read_string(require_member(place, "type"));
    accessor.component_type = read_unsigned(require_member(place, "componentType"), COMPONENT_FLOAT);
    accessor.count = read_unsigned(require_member(place, "count"), MAX_BUFFER_BYTES);
    if (accessor.count == 0)
        refuse(place, "count is 0", REMEDY);
    const JsonPlace normalized = find_member(place, "normalized");
    accessor.is_normalized = normalized.value && normalized.value->is_boolean() && normalized.value->get<bool>();
    const std::uint64_t component_bytes = measure_component(accessor.component_type, place);
    const std::uint64_t element_bytes = measure_element(accessor, component_bytes);
    accessor.is_sparse = find_member(place, "sparse").value != nullptr;
    const auto view_index = read_index(find_member(place, "bufferView"), view_count, "buffer view");
    if (view_index) {
        const BufferView view = check_view(root, *view_index, buffers);
        const std::uint64_t offset = read_unsigned_or(find_member(place, "byteOffset"), MAX_BUFFER_BYTES, 0);
        accessor.stride = view.stride ? view.stride : element_bytes;
        check_extent(place, view, offset, accessor.count, accessor.stride, element_bytes, component_bytes);
        accessor.has_bytes = true;
        accessor.buffer = view.buffer;
        accessor.offset = view.offset + offset;
    }
    if (accessor.is_sparse)
        check_sparse(root, accessor, element_bytes, component_bytes, buffers);
    return accessor;
}

std::vector<unsigned char> read_buffer(const JsonPlace& place, std::size_t index, const std::filesystem::path& folder,
                                       std::optional<std::span<const unsigned char>> binary_chunk,
                                       std::uint64_t budget) {
    const std::uint64_t length = read_unsigned(require_member(place, "byteLength"), MAX_BUFFER_BYTES);
    if (length == 0)
        refuse(place, "byteLength is 0", REMEDY);
    if (length > budget)
        refuse(place, "the buffers together exceed " + std::to_string(MAX_BUFFER_BYTES) + " bytes", "split the scene");
    const JsonPlace uri_place = find_member(place, "uri");
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

std::vector<AccessorSpan> check_accessors(const JsonPlace& root, const BufferBytes& buffers) {
    const std::size_t view_count = count_elements(find_member(root, "bufferViews"), MAX_ENTRIES);
    for (std::size_t i = 0; i < view_count; ++i)
        check_view(root, std::uint32_t(i), buffers);
    const JsonPlace places = find_member(root, "accessors");
    const std::size_t count = count_elements(places, MAX_ENTRIES);
    std::vector<AccessorSpan> accessors;
    for (std::size_t i = 0; i < count; ++i)
        accessors.push_back(check_accessor(root, get_element(places, i), view_count, buffers));
    return accessors;
}

void write_accessors(const std::vector<AccessorSpan>& accessors, const BufferBytes& buffers, Json& approved) {
    for (std::size_t i = 0; i < buffers.size(); ++i)
        approved["buffers"].push_back({{"uri", name_buffer(i)}, {"byteLength", buffers[i].size()}});
    for (const AccessorSpan& accessor : accessors) {
        Json entry{{"type", accessor.type}, {"componentType", accessor.component_type}, {"count", accessor.count}};
        if (accessor.has_bytes) {
            Json view{{"buffer", accessor.buffer},
                      {"byteOffset", accessor.offset},
                      {"byteLength", buffers[accessor.buffer].size() - accessor.offset}};
            if (accessor.stride % 4 == 0 && accessor.stride <= MAX_STRIDE)
                view["byteStride"] = accessor.stride;
            entry["bufferView"] = approved["bufferViews"].size();
            approved["bufferViews"].push_back(std::move(view));
        }
        approved["accessors"].push_back(std::move(entry));
    }
}

std::string name_buffer(std::size_t index) {
    return "buffer-" + std::to_string(index);
}

} // namespace photonloupe
