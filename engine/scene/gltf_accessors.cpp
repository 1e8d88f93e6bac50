// SPDX-License-Identifier: Apache-2.0
// Checked arithmetic on buffer views and accessors; all sums and products are of values below 2^32.
#include "scene/gltf_accessors.h"

#include <array>
#include <cstring>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "scene/gltf_meshopt.h"
#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr const char* REMEDY = "repair the file or export it again";

struct ElementKind {
    const char* type;
    std::uint32_t columns;
    std::uint32_t rows;
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

ElementKind find_kind(const JsonPlace& place) {
    const std::string type = read_string(require_member(place, "type"));
    for (const ElementKind& kind : ELEMENT_KINDS)
        if (type == kind.type)
            return kind;
    refuse(place, "type " + quote_text(type) + " is none of glTF 2.0", REMEDY);
}

// Columns of matrices start at multiples of 4 bytes.
std::uint64_t measure_element(const ElementKind& kind, std::uint64_t component_bytes) {
    const std::uint64_t column = kind.rows * component_bytes;
    return kind.columns == 1 ? column : kind.columns * ((column + 3) / 4 * 4);
}

// What accessors without a buffer view read, again and again: a MAT4 of floats is the largest element.
constexpr std::array<unsigned char, 64> ZEROS{};

// Lets a column view its elements, from the place's byteOffset on. A stride of 0 means packed.
void place_elements(const JsonPlace& place, std::span<const unsigned char> view, std::uint64_t stride,
                    AccessorColumn& column) {
    const std::uint64_t offset = read_unsigned_or(find_member(place, "byteOffset"), MAX_BUFFER_BYTES, 0);
    column.stride = stride ? stride : column.element_bytes;
    if (column.stride < column.element_bytes)
        refuse(place, "the view's byteStride " + std::to_string(stride) + " is shorter than an element", REMEDY);
    const std::uint64_t end = offset + (column.count - 1) * column.stride + column.element_bytes;
    if (end > view.size())
        refuse(place,
               "its " + std::to_string(column.count) + " elements end at byte " + std::to_string(end) +
                   " of a buffer view of " + std::to_string(view.size()),
               REMEDY);
    column.bytes = view.data() + offset;
}

} // namespace

AccessorTable::AccessorTable(const JsonPlace& root, BufferBytes& buffers)
    : m_views(find_member(root, "bufferViews")), m_accessors(find_member(root, "accessors")), m_buffers(buffers),
      m_file_buffer_count(buffers.size()), m_decoded_views(count_elements(m_views, MAX_ENTRIES)),
      m_columns(count_elements(m_accessors, MAX_ENTRIES)) {}

JsonPlace AccessorTable::get_place(std::uint32_t accessor) const {
    return get_element(m_accessors, accessor);
}

const AccessorColumn& AccessorTable::use(std::uint32_t accessor) {
    AccessorColumn& column = m_columns[accessor];
    if (column.bytes)
        return column;
    const JsonPlace place = get_place(accessor);
    column = check_accessor(place);
    if (find_member(place, "sparse").value)
        column = decode_sparse(place, column);
    return column;
}

void AccessorTable::fill(std::uint32_t accessor, AccessorColumn column) {
    if (is_filled(accessor))
        return;
    column.is_normalized = read_flag_or(find_member(get_place(accessor), "normalized"), false);
    m_columns[accessor] = column;
}

void AccessorTable::list_broken(std::vector<std::string>& ignored) {
    std::size_t count = 0;
    std::string first;
    for (std::uint32_t i = 0; i < m_columns.size(); ++i)
        try {
            if (!m_columns[i].bytes)
                check_accessor(get_place(i));
        } catch (const SceneError& error) {
            if (count++ == 0)
                first = error.what();
        }
    if (count > 0)
        ignored.push_back("broken accessors that nothing drawn uses (" + std::to_string(count) + "): " + first);
}

std::span<const unsigned char> AccessorTable::find_bytes(const JsonPlace& place) const {
    const std::size_t buffer = *read_index(require_member(place, "buffer"), m_file_buffer_count, "buffer");
    const std::uint64_t offset = read_unsigned_or(find_member(place, "byteOffset"), MAX_BUFFER_BYTES, 0);
    const std::uint64_t length = read_unsigned(require_member(place, "byteLength"), MAX_BUFFER_BYTES);
    if (length == 0)
        refuse(place, "byteLength is 0", REMEDY);
    if (offset + length > m_buffers[buffer].size())
        refuse(place,
               "it ends at byte " + std::to_string(offset + length) + " of buffer " + std::to_string(buffer) +
                   ", which has " + std::to_string(m_buffers[buffer].size()),
               REMEDY);
    return std::span(m_buffers[buffer]).subspan(offset, length);
}

AccessorTable::BufferView AccessorTable::check_view(const JsonPlace& index_place) {
    const std::uint32_t index = *read_index(index_place, m_decoded_views.size(), "buffer view");
    const JsonPlace place = get_element(m_views, index);
    const std::uint64_t stride = read_unsigned_or(find_member(place, "byteStride"), MAX_BUFFER_BYTES, 0);
    const JsonPlace extension = find_member(find_member(place, "extensions"), "EXT_meshopt_compression");
    if (!extension.value)
        return {find_bytes(place), stride};
    if (m_decoded_views[index].empty()) {
        const std::span<unsigned char> decoded = allocate(extension, measure_meshopt(extension));
        decode_meshopt(extension, find_bytes(extension), decoded);
        m_decoded_views[index] = decoded;
    }
    return {m_decoded_views[index], stride};
}

AccessorColumn AccessorTable::check_accessor(const JsonPlace& place) {
    AccessorColumn column;
    column.component_type = read_unsigned(require_member(place, "componentType"), COMPONENT_FLOAT);
    column.count = read_unsigned(require_member(place, "count"), MAX_BUFFER_BYTES);
    if (column.count == 0)
        refuse(place, "count is 0", REMEDY);
    column.is_normalized = read_flag_or(find_member(place, "normalized"), false);
    const ElementKind kind = find_kind(place);
    column.width = kind.columns * kind.rows;
    column.element_bytes = measure_element(kind, measure_component(column.component_type, place));
    column.bytes = ZEROS.data();
    if (const JsonPlace index = find_member(place, "bufferView"); index.value) {
        const BufferView view = check_view(index);
        place_elements(place, view.bytes, view.stride, column);
    }
    return column;
}

AccessorColumn AccessorTable::check_sparse_part(const JsonPlace& sparse, const char* part, AccessorColumn column) {
    const JsonPlace place = require_member(sparse, part);
    place_elements(place, check_view(require_member(place, "bufferView")).bytes, 0, column);
    return column;
}

AccessorColumn AccessorTable::decode_sparse(const JsonPlace& place, AccessorColumn column) {
    const JsonPlace sparse = find_member(place, "sparse");
    const std::uint64_t count = column.count;
    const std::span<unsigned char> packed = allocate(place, count * column.element_bytes);
    for (std::uint64_t i = 0; i < count; ++i)
        std::memcpy(&packed[i * column.element_bytes], column.bytes + i * column.stride, column.element_bytes);
    column.bytes = packed.data();
    column.stride = column.element_bytes;
    AccessorColumn indices, values = column;
    indices.count = values.count = read_unsigned(require_member(sparse, "count"), count);
    if (values.count == 0)
        refuse(sparse, "count is 0", REMEDY);
    const JsonPlace type = require_member(require_member(sparse, "indices"), "componentType");
    indices.component_type = read_unsigned(type, COMPONENT_UNSIGNED_INT);
    if (!indices.is_unsigned())
        refuse(type, "sparse indices must be of unsigned 8, 16 or 32 bits", REMEDY);
    indices.element_bytes = measure_component(indices.component_type, type);
    indices = check_sparse_part(sparse, "indices", indices);
    values = check_sparse_part(sparse, "values", values);
    for (std::uint64_t i = 0; i < values.count; ++i) {
        const std::uint64_t target = indices.read_unsigned(i);
        if (target >= count)
            refuse(sparse, "it replaces element " + std::to_string(target) + " of " + std::to_string(count), REMEDY);
        std::memcpy(&packed[target * column.element_bytes], values.bytes + i * values.stride, column.element_bytes);
    }
    return column;
}

std::span<unsigned char> AccessorTable::allocate(const JsonPlace& place, std::uint64_t byte_count) {
    if (byte_count > MAX_DECODED_BYTES - m_decoded_bytes)
        refuse(place, "what is decoded exceeds " + std::to_string(MAX_DECODED_BYTES) + " bytes", "split the scene");
    m_decoded_bytes += byte_count;
    return m_buffers.emplace_back(byte_count);
}

} // namespace photonloupe
