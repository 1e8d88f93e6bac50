// SPDX-License-Identifier: Apache-2.0
// Some rows of a map's columns.
#pragma once

#include <span>

#include "photons/photon_map.h"

namespace photonloupe {

// Rows of a column by photon id, of as many values each as there are.
template <class T>
std::vector<T> select_rows(const std::vector<T>& column, std::uint64_t photon_count,
                           std::span<const std::uint32_t> ids) {
    const std::size_t width = photon_count ? column.size() / photon_count : 0;
    std::vector<T> rows;
    rows.reserve(width * ids.size());
    for (const std::uint32_t id : ids)
        rows.insert(rows.end(), column.begin() + static_cast<std::ptrdiff_t>(width * id),
                    column.begin() + static_cast<std::ptrdiff_t>(width * (id + std::size_t{1})));
    return rows;
}

// Rows `ids` of a column of `count` rows on the device, `width` values each. Where memory is not shared one transfer is
// quicker than hundreds.
template <class T>
std::vector<T> read_rows(const gpu::Buffer& column, std::uint64_t count, std::span<const std::uint32_t> ids,
                         std::uint32_t width = 1) {
    constexpr std::uint64_t FEW_DIVISOR = 16; // below this share of the column rows are read one by one
    if (!column.mapped() || ids.size() * FEW_DIVISOR >= count)
        return ids.empty() ? std::vector<T>{} : select_rows(column.read<T>(count * width), count, ids);
    std::vector<T> rows(ids.size() * width);
    for (std::size_t i = 0; i < ids.size(); ++i)
        column.download(&rows[i * width], width * sizeof(T), std::uint64_t{ids[i]} * width * sizeof(T));
    return rows;
}

PhotonMap select_photons(gpu::Device& device, const PhotonMap& map, std::span<const std::uint32_t> ids);

// The paths of some of `photon_count` photons, moved by `shift`. Throws Error when they have more vertices than 32 bits
// count.
PathColumns select_paths(gpu::Device& device, const PathColumns& paths, std::uint64_t photon_count,
                         std::span<const std::uint32_t> ids, const std::array<double, 3>& shift = {});

} // namespace photonloupe
