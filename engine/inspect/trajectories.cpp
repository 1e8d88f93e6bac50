// SPDX-License-Identifier: Apache-2.0
// Directions to angles about a pole.
#include "inspect/trajectories.h"

#include <cmath>
#include <limits>
#include <map>

#include <glm/geometric.hpp>

namespace photonloupe::inspect {
namespace {

constexpr double PARALLEL = 1e-5; // apart directions of rounded vertices may be that are one
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

// Of directional light all directions are one: what tells its photons apart is where they start, on a disc of radius 1
// that holds them all (METHODS §4).
struct LaunchDisc {
    glm::dvec3 lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};
    bool is_parallel = true;
};

// The angle that an angle's place in the plane stands for is its length: of a start, its share of the radius.
Trajectory measure_start(const glm::dvec3& start, const LaunchDisc& disc, const glm::dvec3& pole) {
    const double radius = 0.5 * glm::length(disc.hi - disc.lo);
    const glm::dvec3 off = radius > 0 ? (start - 0.5 * (disc.lo + disc.hi)) / radius : glm::dvec3(0.0);
    const Trajectory about = measure_angles(off, pole);
    return {glm::length(off), about.phi};
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
    std::map<std::int32_t, LaunchDisc> discs;
    for (std::size_t i = 0; i < directions.size(); ++i)
        if (directions[i] != glm::dvec3(0.0)) {
            LaunchDisc& disc = discs[emitters[i]];
            const glm::dvec3 start(paths.view(i).vertices.front());
            disc.lo = glm::min(disc.lo, start);
            disc.hi = glm::max(disc.hi, start);
            disc.is_parallel &= glm::distance(directions[i], poles.at(emitters[i])) < PARALLEL;
        }
    std::vector<Trajectory> trajectories(directions.size(), {UNDEFINED, UNDEFINED});
    for (std::size_t i = 0; i < directions.size(); ++i) {
        if (directions[i] == glm::dvec3(0.0))
            continue;
        const glm::dvec3& pole = poles.at(emitters[i]);
        const LaunchDisc& disc = discs.at(emitters[i]);
        const bool has_starts = disc.is_parallel && disc.lo != disc.hi;
        trajectories[i] = has_starts ? measure_start(glm::dvec3(paths.view(i).vertices.front()), disc, pole)
                                     : measure_angles(directions[i], pole);
    }
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
