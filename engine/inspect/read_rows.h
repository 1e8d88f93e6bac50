// SPDX-License-Identifier: Apache-2.0
// A few rows of a long column, as a loupe needs them.
#pragma once

#include <cstring>
#include <span>
#include <vector>

#include "gpu/buffer.h"

namespace photonloupe::inspect {

// Rows `ids` of a column of `count`. Where memory is not shared one transfer is quicker than hundreds.
template <class T>
std::vector<T> read_rows(const gpu::Buffer& column, std::uint64_t count, std::span<const std::uint32_t> ids) {
    std::vector<T> rows(ids.size());
    const auto* shared = static_cast<const unsigned char*>(column.mapped());
    const std::vector<T> all = shared || ids.empty() ? std::vector<T>{} : column.read<T>(count);
    for (std::size_t i = 0; i < ids.size(); ++i)
        if (shared)
            std::memcpy(&rows[i], shared + ids[i] * sizeof(T), sizeof(T));
        else
            rows[i] = all[ids[i]];
    return rows;
}

} // namespace photonloupe::inspect
