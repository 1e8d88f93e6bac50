// SPDX-License-Identifier: Apache-2.0
// The columns that views can plot of a map: places, flux, paths, parameters, and what relaxation left.
#pragma once

#include <string>
#include <vector>

#include "inspect/column.h"
#include "known_photons.h"

namespace photonloupe::inspect {

// A column before anybody computes it.
struct ColumnInfo {
    std::string name;  // as users type it
    std::string label; // with its unit
    float period = 0;  // 0: it does not wrap
    bool is_discrete = false;
    bool needs_paths = false;
    std::string missing; // what to do before it can be had; empty: it can be had now
};

// All columns, those included that cannot be had yet. A parameter whose name another column has is "parameter.NAME".
std::vector<ColumnInfo> list_columns(const Photons& photons);

// What columns call the parameters, in their order.
std::vector<std::string> list_parameter_columns(const Photons& photons);

// One of them, computed now. Throws Error naming the columns there are, or saying what the map lacks for it.
Column find_column(gpu::Device& device, Photons& photons, const std::string& name, const Progress& progress = {});

// Linear colors by photon: "encoding" (a script's, else one of its own each), or those of a column by its name.
std::vector<glm::vec3> find_photon_colors(gpu::Device& device, Photons& photons, const std::string& color,
                                          const Progress& progress = {});

// Photons an isotropy is measured of ([SJL15] section 5.2).
inline constexpr std::uint32_t ISOTROPY_NEIGHBORS = 100;

} // namespace photonloupe::inspect
