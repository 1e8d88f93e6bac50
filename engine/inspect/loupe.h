// SPDX-License-Identifier: Apache-2.0
// The loupe: the photons around a point or a photon, and what is worth knowing of the one at its center.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "inspect/settings.h"
#include "inspect/spread.h"
#include "known_photons.h"
#include "photons/nearest_query.h"

namespace photonloupe::inspect {

struct LoupeQuery : LoupeSettings {
    std::array<double, 3> point{};       // world, metres; where `photon` is empty
    std::optional<glm::vec3> normal;     // of the surface at the point: the center lies on its side
    std::optional<std::uint32_t> photon; // instead of a point: around this photon, itself left out
    // What locks the layer while the point moves: a pinned photon, or ranges of all parameters. Neither: the layer is
    // the center's.
    std::optional<std::uint32_t> pinned;
    std::vector<float> low, high;
};

// How far a neighbour drifted along its own constraint basis (METHODS §5.5).
struct DriftEllipse {
    glm::vec3 along, across;               // u_b, v_b
    float half_along = 0, half_across = 0; // |D·u_b|, |D·v_b|, metres
};

inline constexpr float UNKNOWN = std::numeric_limits<float>::quiet_NaN();

// What is known of the center; NaN: undefined, or not measured.
struct LoupeNumbers {
    std::array<double, 3> position{}; // world, metres
    glm::vec3 power{};                // W
    std::vector<std::pair<std::string, float>> parameters;
    std::string interactions; // "RT": reflected, then transmitted (V: scattered); empty: none, or no paths
    double signature = 0;     // [SJL15] eq. 2
    double tortuosity = 0;    // [SJL15] eq. 1
    double path_length = 0;   // metres
    float one_sidedness = 0;  // c_m
    float drift = 0;          // metres
    float pressure = 0;
};

struct LoupeView {
    std::optional<std::uint32_t> center; // nearest photon of that surface; none: the map is empty
    std::vector<std::uint32_t> ids;      // found, nearest first, ties by id; up to k
    std::vector<float> distances;        // metres, or in parameter space
    float radius = 0;                    // world metres to the farthest of them, from the point or photon
    std::array<double, 3> origin{};      // world place of positions' (0, 0, 0)
    std::vector<glm::vec3> positions;    // of those found
    std::vector<glm::vec3> colors;       // linear, grey where unset; empty: the map has none
    glm::vec3 place{};                   // of the loupe: the point, or the photon
    glm::vec3 center_position{};
    glm::vec3 center_normal{};
    Spread spread;                               // of the found photons in the center's tangent plane
    bool has_constraint = false;                 // else basis is that of `spread`, and both freedoms are 1
    glm::vec3 along, across;                     // u_b, v_b of the center
    float freedom_along = 1, freedom_across = 1; // 1 − w_u, 1 − w_v
    std::vector<DriftEllipse> ellipses;          // of those found; empty: the map was not relaxed
    LoupeNumbers numbers;
};

// Throws Error for an id, a k or ranges that do not fit the map, and where the space lacks parameters.
LoupeView look_through_loupe(gpu::Device& device, Photons& photons, const LoupeQuery& query,
                             const Progress& progress = {});

// A photon's path as a polyline, relative to the map's origin; interactions as in the map's path columns.
struct PathLine {
    std::vector<glm::vec3> points;
    std::vector<std::uint8_t> interactions;
};

// Throws Error when the map has no paths, or an id is not a photon.
std::vector<PathLine> read_path_lines(const Photons& photons, std::span<const std::uint32_t> ids);

} // namespace photonloupe::inspect
