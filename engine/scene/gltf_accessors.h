// SPDX-License-Identifier: Apache-2.0
// Checks buffer views and accessors against the bytes that are really there, and decodes what is sparse or compressed.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/json_place.h"
#include "scene/accessor_column.h"
#include "scene/gltf_buffers.h"

namespace photonloupe {

// Checks each accessor when it is first used: what nothing uses may be broken.
class AccessorTable {
public:
    // Columns view `buffers`; what is decoded is appended there.
    AccessorTable(const JsonPlace& root, BufferBytes& buffers);

    std::size_t get_count() const { return m_columns.size(); }
    JsonPlace get_place(std::uint32_t accessor) const;
    const AccessorColumn& use(std::uint32_t accessor);

    // For decoders: the bytes of a buffer view, room for what they hold, and the accessor that shall read it.
    // An accessor that was filled or used before stays what it is.
    std::span<const unsigned char> check_view_bytes(const JsonPlace& index_place) {
        return check_view(index_place).bytes;
    }
    std::span<unsigned char> allocate(const JsonPlace& place, std::uint64_t byte_count);
    bool is_filled(std::uint32_t accessor) const { return m_columns[accessor].bytes != nullptr; }
    void fill(std::uint32_t accessor, AccessorColumn column);

    // By accessor; those that were not used have no bytes.
    std::vector<AccessorColumn> take_columns() { return std::move(m_columns); }
    // One sentence if accessors that nothing used are broken.
    void list_broken(std::vector<std::string>& ignored);

private:
    struct BufferView {
        std::span<const unsigned char> bytes;
        std::uint64_t stride = 0; // 0: packed
    };

    std::span<const unsigned char> find_bytes(const JsonPlace& place) const;
    BufferView check_view(const JsonPlace& index_place);
    // Of zeros without a buffer view.
    AccessorColumn check_accessor(const JsonPlace& place);
    AccessorColumn check_sparse_part(const JsonPlace& sparse, const char* part, AccessorColumn column);
    AccessorColumn decode_sparse(const JsonPlace& place, AccessorColumn column);

    JsonPlace m_views, m_accessors;
    BufferBytes& m_buffers;
    std::size_t m_file_buffer_count;
    std::vector<std::span<const unsigned char>> m_decoded_views; // by buffer view
    std::uint64_t m_decoded_bytes = 0;
    std::vector<AccessorColumn> m_columns;
};

} // namespace photonloupe
