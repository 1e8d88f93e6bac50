// SPDX-License-Identifier: Apache-2.0
// Commands of the loupe and of relaxation.
#include <algorithm>

#include "studio/edit_state.h"
#include "studio/stage_choices.h"

namespace photonloupe::studio {
namespace {

constexpr std::size_t MOST_PINS = 8;
constexpr double GROWTH = 1.25;

void toggle_lock(Workspace& workspace, const char* lock) {
    change_loupe(workspace, "lock range", [&](LoupeState& loupe) {
        loupe.lock = loupe.lock == lock ? "none" : lock;
        if (loupe.lock == lock)
            loupe.space = SearchSpace::constrained;
    });
}

// Steps made with other choices are those of another relaxation.
void begin_relaxation(StudioState& state) {
    RelaxState& relax = state.relax;
    const RelaxSettings chosen = decide_steps(state);
    if (relax.used != chosen)
        relax.made = 0;
    relax.used = chosen;
    relax.is_measured = true;
}

} // namespace

void pin_photon(Workspace& workspace) {
    if (!workspace.loupe || !workspace.loupe->center) {
        workspace.say("the loupe sees no photon to pin; move the cursor onto some");
        return;
    }
    const std::uint32_t photon = *workspace.loupe->center;
    change_loupe(workspace, "pin", [&](LoupeState& loupe) {
        std::erase(loupe.pins, photon);
        loupe.pins.push_back(photon);
        if (loupe.pins.size() > MOST_PINS)
            loupe.pins.erase(loupe.pins.begin());
    });
}

void unpin_photons(Workspace& workspace) {
    change_loupe(workspace, "unpin", [](LoupeState& loupe) {
        loupe.pins.clear();
        if (loupe.lock == "pin")
            loupe.lock = "none";
    });
}

void lock_to_pin(Workspace& workspace) {
    if (workspace.state.loupe.lock != "pin" && workspace.state.loupe.pins.empty())
        pin_photon(workspace);
    if (!workspace.state.loupe.pins.empty())
        toggle_lock(workspace, "pin");
}

void lock_to_brushes(Workspace& workspace) {
    toggle_lock(workspace, "brushes");
}

void grow_loupe(Workspace& workspace) {
    change_loupe(workspace, "loupe size", [](LoupeState& loupe) {
        loupe.k = std::min(MOST_NEIGHBORS, static_cast<std::uint32_t>(loupe.k * GROWTH) + 1);
    });
}

void shrink_loupe(Workspace& workspace) {
    change_loupe(workspace, "loupe size",
                 [](LoupeState& loupe) { loupe.k = std::max(1u, static_cast<std::uint32_t>(loupe.k / GROWTH)); });
}

void change_space(Workspace& workspace) {
    change_loupe(workspace, "loupe space", [](LoupeState& loupe) {
        loupe.space = static_cast<SearchSpace>((static_cast<std::uint32_t>(loupe.space) + 1) % 3);
    });
}

void toggle_paths(Workspace& workspace) {
    change_loupe(workspace, "light paths", [](LoupeState& loupe) { loupe.shows_paths = !loupe.shows_paths; });
}

void measure_constraint_command(Workspace& workspace) {
    workspace.change("measure constraint", [](StudioState& state) {
        begin_relaxation(state);
        state.relax.made = 0;
    });
}

void step_relaxation(Workspace& workspace) {
    workspace.done.erase("relax");
    workspace.change("relaxation step", [](StudioState& state) {
        begin_relaxation(state);
        ++state.relax.made;
        state.view.shows_relaxed = true;
    });
}

void run_relaxation(Workspace& workspace) {
    workspace.done.erase("relax");
    workspace.change("relax", [](StudioState& state) {
        begin_relaxation(state);
        state.relax.made = std::max(*state.relax.used.steps, state.relax.made);
        state.view.shows_relaxed = true;
    });
}

void reset_relaxation(Workspace& workspace) {
    workspace.change("reset relaxation", [](StudioState& state) {
        state.relax.made = 0;
        state.relax.is_measured = false;
        state.view.shows_relaxed = false;
    });
}

} // namespace photonloupe::studio
