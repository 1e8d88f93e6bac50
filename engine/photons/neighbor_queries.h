// SPDX-License-Identifier: Apache-2.0
// Queries for neighbours from what a user names: photons, points, values of parameters, a center, intervals.
#pragma once

#include <span>

#include "photons/layers.h"

namespace photonloupe {

// What is asked, a query after the other as the user named them.
struct NeighborQueries {
    std::vector<glm::vec4> points;    // xyz relative to the map's origin, w bits: the photon itself, or NOBODY
    std::vector<glm::vec4> rows;      // layer number and parameters of each, where they decide
    std::vector<float> reach2;        // squared reach in parameter space of each, of layers
    std::vector<glm::vec4> intervals; // the least row, then the greatest; empty: no intervals
    std::uint32_t row_count = 0;
};

// Throws Error naming the row of an id that the map does not have.
NeighborQueries ask_about(const PhotonMap& photons, std::span<const std::uint32_t> ids);
NeighborQueries ask_at(std::span<const glm::vec4> points);

// Photons by id, with their rows.
NeighborQueries ask_with_rows(const PhotonMap& photons, const ParameterRows& parameters,
                              std::span<const std::uint32_t> ids);
// Points of parameter space, all parameters of each, of any emitter.
NeighborQueries ask_parameters_at(const ParameterRows& parameters, std::span<const double> values);

// Makes queries seek in a layer: each in its own, or all in that of the one whose row and reach are given.
void seek_in_layer(NeighborQueries& queries, std::span<const glm::vec4> row, float reach2);
// Makes queries seek among photons that have parameters within intervals; one that ends before it begins goes over the
// seam.
void seek_in_intervals(NeighborQueries& queries, std::span<const float> low, std::span<const float> high);

// Squared reach β·r_q of a layer.
float scale_reach2(float radius2, float beta);

// The queries on the device, in an order in which those that follow each other look at the same photons.
struct OrderedQueries {
    gpu::Buffer points, rows, reach2, intervals;
    gpu::Buffer result_rows; // the place of each among the queries as they were named
    std::uint64_t count = 0;

    Queries view() const;
};

OrderedQueries order_queries(gpu::Device& device, const NeighborQueries& queries);

// Along a Morton curve, so that neighboring lanes look at neighboring photons.
std::vector<std::uint32_t> order_points(std::span<const glm::vec4> points);

} // namespace photonloupe
