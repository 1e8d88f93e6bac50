// SPDX-License-Identifier: Apache-2.0
// Who may be found from where, and how far they count as being: what every search over photons shares
// (shaders/photons/candidates.glsl).
#pragma once

#include <string>

#include "gpu/commands.h"
#include "photons/kd_tree.h"

namespace photonloupe {

// Largest height above the tangent plane, as a share of r, of photons on the same surface (METHODS §2).
inline constexpr float SURFACE_FLATNESS = 0.1f;

enum class Measure {
    world,      // distance in space, whatever the surface
    surface,    // the radius that takes a photon of the same surface in (METHODS §2)
    parameters, // distance in parameter space, of photons with the query's layer number
};

// Who may be found.
struct Neighborhood {
    const KdTree& tree;
    Measure measure = Measure::world;
    bool is_layered = false;                  // in space: only photons of the query's layer
    const gpu::Buffer* intervals = nullptr;   // in space: only photons whose rows lie between these two
    std::uint32_t axis_count = 0;             // of rows, where parameters decide
    const gpu::Buffer* row_periods = nullptr; // a vec4 for each of a row's
    bool has_periods = false;                 // a parameter wraps
    float flatness = SURFACE_FLATNESS;        // of Measure::surface; 0: heights do not matter
    std::array<float, 3> period{};            // metres after which space repeats; 0: it does not
    std::string flat_axes;                    // "xz": all photons and queries lie in one plane of these axes; "": not
    bool has_one_normal = false;              // all photons share a normal
};

// From where; all buffers in the order in which the queries are asked.
struct Queries {
    std::uint64_t count = 0;
    const gpu::Buffer* points = nullptr;  // xyz relative to the map's origin, w bits: the photon's own id
    const gpu::Buffer* normals = nullptr; // of Measure::surface; a zero normal finds nobody
    const gpu::Buffer* rows = nullptr;    // layer number and parameters, where they decide
    const gpu::Buffer* reach2 = nullptr;  // squared reach in parameter space, of layers
    bool are_photons = false;             // the tree's, in its order
};

// The photons of a tree, each asking for its own neighbours; `reach2` in tree order, where layers decide.
Queries ask_photons(const KdTree& tree, const gpu::Buffer* reach2 = nullptr);

// The axes of the plane in which all photons lie, if they share a normal along the third.
std::string find_flat_axes(const KdTree& tree);

// Whether all photons have the same normal.
bool find_one_normal(const KdTree& tree);

// What kernels that include photons/candidates.glsl are specialised to.
std::vector<std::string> list_defines(const Neighborhood& neighborhood, const Queries& queries);
// What they bind.
std::vector<gpu::Binding> list_bindings(const Neighborhood& neighborhood, const Queries& queries);

} // namespace photonloupe
