// SPDX-License-Identifier: Apache-2.0
// Turns the state's choices into queries of engine/inspect.
#include "studio/loupe_query.h"

#include <chrono>

#include "core/error.h"
#include "core/settings.h"

namespace photonloupe::studio {
namespace {

// The brushes of the parameters' axes; those without one take everything.
void lock_to_ranges(Workspace& workspace, inspect::LoupeQuery& query) {
    for (const std::string& parameter : workspace.list_parameters()) {
        float low = -3e38f, high = 3e38f;
        for (const AxisState& axis : workspace.state.parallel.axes)
            if (axis.name == parameter && !axis.brushes.empty()) {
                low = axis.brushes.front()[0];
                high = axis.brushes.front()[1];
            }
        query.low.push_back(low);
        query.high.push_back(high);
    }
}

inspect::LoupeQuery make_query(Workspace& workspace, const Photons& photons) {
    const LoupeState& loupe = workspace.state.loupe;
    inspect::LoupeQuery query{loupe};
    if (query.space == SearchSpace::constrained && photons.map.parameters) {
        if (loupe.lock == "pin" && !loupe.pins.empty())
            query.pinned = loupe.pins.back();
        if (loupe.lock == "brushes")
            lock_to_ranges(workspace, query);
    }
    return query;
}

std::string write_key(const Workspace& workspace, const Photons* photons) {
    const LoupeState& loupe = workspace.state.loupe;
    std::string key =
        write_values(workspace.loupe_version, workspace.results.photons_version, photons,
                     write_settings<inspect::LoupeSettings>(loupe), loupe.lock, loupe.point[0], loupe.point[1],
                     loupe.point[2], loupe.lock == "brushes" ? workspace.selection_version : 0);
    for (const std::uint32_t pin : loupe.pins)
        key += write_values(pin);
    return key;
}

void look(Workspace& workspace, Photons& photons) {
    inspect::LoupeQuery query = make_query(workspace, photons);
    if (workspace.state.loupe.has_point) {
        query.point = workspace.state.loupe.point;
        query.normal = workspace.loupe_normal;
        workspace.loupe = inspect::look_through_loupe(workspace.device, photons, query);
    }
    for (const std::uint32_t pin : workspace.state.loupe.pins) {
        if (pin >= photons.map.count)
            continue;
        inspect::LoupeQuery around = make_query(workspace, photons);
        around.photon = pin;
        around.low.clear();
        around.high.clear();
        around.pinned.reset();
        workspace.pinned[pin] = inspect::look_through_loupe(workspace.device, photons, around);
    }
}

} // namespace

void move_loupe(Workspace& workspace, const std::array<double, 3>& point, const std::optional<glm::vec3>& normal) {
    workspace.state.loupe.point = point;
    workspace.state.loupe.has_point = true;
    workspace.loupe_normal = normal;
}

void update_loupe(Workspace& workspace) {
    Photons* photons = workspace.shown();
    const std::string key = write_key(workspace, photons);
    if (key == workspace.loupe_key)
        return;
    workspace.loupe_key = key;
    workspace.loupe.reset();
    workspace.pinned.clear();
    workspace.loupe_missing.clear();
    ++workspace.loupe_result_version;
    if (!photons || photons->map.count == 0) {
        workspace.loupe_missing = "there are no photons to look at; open a scene";
        return;
    }
    const auto start = std::chrono::steady_clock::now();
    try {
        look(workspace, *photons);
    } catch (const Error& error) {
        workspace.loupe_missing = error.what();
    }
    workspace.loupe_times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
}

} // namespace photonloupe::studio
