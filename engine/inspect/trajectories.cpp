// SPDX-License-Identifier: Apache-2.0
// Directions to angles about a pole.
#include "inspect/trajectories.h"

#include <cmath>
#include <limits>
#include <map>

#include <glm/geometric.hpp>

namespace photonloupe::inspect {
namespace {

constexpr double UNDEFINED = std::numeric_limits<double>::quiet_NaN();

// Angles of t about the unit vector w, in the branchless basis of Duff et al. (JCGT 6(1), 2017) with z as its pole.
Trajectory measure_angles(const glm::dvec3& t, const glm::dvec3& w) {
    const double side = w.z < 0 ? -1.0 : 1.0;
    const double h = -(w.x * t.x + w.y * t.y) / (side + w.z) - t.z;
    const double along_u = t.x + side * w.x * h;
    const double along_v = side * t.y + w.y * h;
    // atan2 where the equation has acos, which near 0 would lose half its digits.
    return {std::atan2(std::hypot(along_u, along_v), glm::dot(t, w)), std::atan2(along_u, along_v)};
}

// Zero where there is none.
glm::dvec3 find_emission(const PathView& path) {
    if (path.vertices.size() < 2)
        return glm::dvec3(0.0);
    const glm::dvec3 first = find_segment(path, 0);
    const double length = glm::length(first);
    return length > 0 ? first / length : glm::dvec3(0.0);
}

// y up becomes z up: what lies east stays, what lies north (-z) is y.
glm::dvec3 stand_up(const glm::dvec3& v) {
    return {v.x, -v.z, v.y};
}

} // namespace

std::vector<Trajectory> find_primal_trajectories(const HostPaths& paths, const std::vector<std::int32_t>& emitters) {
    std::vector<glm::dvec3> directions(emitters.size());
    std::map<std::int32_t, glm::dvec3> poles;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        directions[i] = find_emission(paths.view(i));
        poles.try_emplace(emitters[i], 0.0).first->second += directions[i];
    }
    for (auto& [emitter, pole] : poles) {
        const double length = glm::length(pole);
        pole = length > 0 ? pole / length : glm::dvec3(0, 0, 1); // directions that cancel: any axis
    }
    std::vector<Trajectory> trajectories(directions.size(), {UNDEFINED, UNDEFINED});
    for (std::size_t i = 0; i < directions.size(); ++i)
        if (directions[i] != glm::dvec3(0.0))
            trajectories[i] = measure_angles(directions[i], poles.at(emitters[i]));
    return trajectories;
}

Trajectory find_incident_trajectory(const PathView& path) {
    const glm::dvec3 back = -find_arrival(path);
    const glm::dvec3 normal = path.normals.empty() ? glm::dvec3(0.0) : glm::dvec3(path.normals.back());
    if (std::isnan(back.x) || normal == glm::dvec3(0.0))
        return {UNDEFINED, UNDEFINED};
    return measure_angles(stand_up(back), stand_up(glm::normalize(normal)));
}

} // namespace photonloupe::inspect
