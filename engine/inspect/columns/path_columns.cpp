// SPDX-License-Identifier: Apache-2.0
// Columns that are measured along the photons' paths.
#include <cmath>
#include <numbers>

#include "inspect/columns/column_source.h"
#include "inspect/trajectories.h"
#include "photons/map_columns.h"

namespace photonloupe::inspect {
namespace {

constexpr float TURN = 2 * std::numbers::pi_v<float>;

// A number of each photon's path.
template <class Measure>
auto measure_each(const Measure& measure) {
    return [measure](const Photons& photons) {
        const HostPaths paths = read_paths(photons.map);
        std::vector<float> values(photons.map.count);
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = static_cast<float>(measure(paths.view(i)));
        return values;
    };
}

auto measure_arrival(int axis) {
    return measure_each([axis](const PathView& path) { return find_arrival(path)[axis]; });
}

using Angle = double (*)(const Trajectory&);

double take_theta(const Trajectory& t) {
    return t.theta;
}
double take_phi(const Trajectory& t) {
    return t.phi;
}
// The planar form, in which distances are taken (METHODS §4).
double take_u(const Trajectory& t) {
    return t.theta * std::sin(t.phi);
}
double take_v(const Trajectory& t) {
    return t.theta * std::cos(t.phi);
}

auto measure_incident(Angle take) {
    return measure_each([take](const PathView& path) { return take(find_incident_trajectory(path)); });
}

auto measure_primal(Angle take) {
    return [take](const Photons& photons) {
        std::vector<float> values;
        for (const Trajectory& t : find_primal_trajectories(read_paths(photons.map), read_emitters(photons.map)))
            values.push_back(static_cast<float>(take(t)));
        return values;
    };
}

} // namespace

void list_path_sources(std::vector<ColumnSource>& sources) {
    using Compute = std::function<std::vector<float>(const Photons&)>;
    const auto add = [&](const char* name, const char* label, Compute compute, bool is_discrete = false) {
        sources.push_back({name, label, Needs::paths, 0, 0, 0, is_discrete, std::move(compute)});
    };
    const auto add_angle = [&](const char* name, const char* label, Compute compute) {
        sources.push_back({name, label, Needs::paths, -TURN / 2, TURN / 2, TURN, false, std::move(compute)});
    };
    add("primal_theta", "primal θ [rad]", measure_primal(take_theta));
    add_angle("primal_phi", "primal φ [rad]", measure_primal(take_phi));
    add("primal_u", "primal θ sin φ [rad]", measure_primal(take_u));
    add("primal_v", "primal θ cos φ [rad]", measure_primal(take_v));
    add("incident_theta", "incident θ [rad]", measure_incident(take_theta));
    add_angle("incident_phi", "incident φ [rad]", measure_incident(take_phi));
    add("incident_u", "incident θ sin φ [rad]", measure_incident(take_u));
    add("incident_v", "incident θ cos φ [rad]", measure_incident(take_v));
    add("arrival_x", "direction of arrival, x", measure_arrival(0));
    add("arrival_y", "direction of arrival, y", measure_arrival(1));
    add("arrival_z", "direction of arrival, z", measure_arrival(2));
    add("path_length", "path length [m]", measure_each(measure_length));
    add("vertices", "path vertices", measure_each([](const PathView& path) { return double(path.vertices.size()); }),
        true);
    add("signature", "signature", measure_each(encode_signature), true);
    add("tortuosity", "tortuosity", measure_each(measure_tortuosity));
    add_angle("normal_angle", "normal angle φₙ [rad]", measure_each(measure_normal_angle));
}

} // namespace photonloupe::inspect
