// SPDX-License-Identifier: Apache-2.0
// Trajectories: the direction in which a photon left its light, or reached its surface ([SJL15] eq. 3, METHODS §4).
#pragma once

#include <vector>

#include "inspect/path_view.h"

namespace photonloupe::inspect {

// θ 0 … π from the pole, φ about it, radians; NaN where a path has no such segment of any length.
struct Trajectory {
    double theta = 0, phi = 0;
};

// Leaving the emitter, about the mean direction of all photons of the same emitter.
std::vector<Trajectory> find_primal_trajectories(const HostPaths& paths, const std::vector<std::int32_t>& emitters);

// Back along the last segment, about the receiver's normal; the basis has y as its pole.
Trajectory find_incident_trajectory(const PathView& path);

} // namespace photonloupe::inspect
