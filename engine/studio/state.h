// SPDX-License-Identifier: Apache-2.0
// Everything a user chooses, as a value: what undo goes back to and what a session saves.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "estimate/settings.h"
#include "inspect/settings.h"
#include "relax/settings.h"

namespace photonloupe::studio {

// Photon ids, ascending; shared, so that states are cheap to copy. Null: nothing is selected.
using Ids = std::shared_ptr<const std::vector<std::uint32_t>>;

struct TraceState : TraceSettings {
    std::string scene;                  // path; empty: none
    std::string map;                    // path of a saved map that takes the place of tracing; empty: none
    std::vector<std::string> additions; // to the scene's file (scene/edit_scene.h), JSON each
    TraceState() { count = 50'000; }    // to be looked at soon
    bool operator==(const TraceState&) const = default;
};

struct ScriptState {
    std::string path;                     // where the text came from; empty: nowhere
    std::string text;                     // in the editor
    std::string ran;                      // the last text that ran; empty: none
    std::map<std::string, double> values; // of exposed variables, where they differ from the script's own
    bool operator==(const ScriptState&) const = default;
};

enum class ViewMode { points = 1, voronoi, kd_tree, colored_points, render, colored_render, map };

// Looks at `target` from `distance`; yaw and pitch in radians, about y and up from the horizon.
struct CameraState {
    bool is_set = false; // false: fit what there is
    std::array<double, 3> target{};
    double yaw = 0.6, pitch = 0.7, distance = 1, yfov = 0.7;
    bool operator==(const CameraState&) const = default;
};

struct ViewState {
    ViewMode mode = ViewMode::points;
    CameraState camera;
    bool shows_relaxed = false; // where there are relaxed photons
    bool is_split = false;      // traced photons left of the line, relaxed ones right of it
    float split_at = 0.5f;
    float point_size = 2.0f; // pixels
    float brightness = 0.0f; // stops
    int tree_depth = -1;     // -1: leaves
    std::string map_column = "w_v";
    bool operator==(const ViewState&) const = default;
};

struct LoupeState : inspect::LoupeSettings {
    std::string lock = "none"; // none: the range follows the cursor's photon; pin: that of the last pin; brushes
    bool has_point = false;
    std::array<double, 3> point{}; // where the cursor is, metres
    std::vector<std::uint32_t> pins;
    bool shows_paths = false;
    bool shows_drift = true;
    std::vector<std::string> numbers = {"position", "parameters", "flux", "signature", "eigenvalues", "w_v"};
    bool operator==(const LoupeState&) const = default;
};

struct AxisState {
    std::string name;
    float low = 0, high = 0; // equal: the column's own range
    bool is_flipped = false;
    bool is_closed = false;
    std::uint32_t periods = 1;
    std::vector<std::array<float, 2>> brushes;
    bool operator==(const AxisState&) const = default;
};

struct ParallelState {
    std::vector<AxisState> axes;
    float tension = 1.0f;
    std::string source = "loupe";   // loupe, all, selection
    std::string color = "encoding"; // or a column
    bool shows_density = true;
    bool operator==(const ParallelState&) const = default;
};

struct ScatterState {
    std::string x = "x", y = "z";
    bool is_polar = false;
    std::string source = "all";
    bool shows_pair = false; // the loupe's photons in world and parameter space side by side
    bool operator==(const ScatterState&) const = default;
};

struct HistogramState {
    std::string column = "power";
    std::uint32_t bins = 64;
    float threshold = 0.0f;
    bool shows_cdf = true;
    bool operator==(const HistogramState&) const = default;
};

struct RelaxState {
    RelaxSettings choices;    // as they stand in the panel
    RelaxSettings used;       // of the steps that were made; how many were meant is decided
    std::uint32_t made = 0;   // steps
    bool is_measured = false; // the constraint is known, even of no steps
    bool is_wanted() const { return made > 0 || is_measured; }
    bool operator==(const RelaxState&) const = default;
};

struct ImageState {
    float exposure = 0.0f;     // stops
    std::string tone = "srgb"; // srgb, filmic
    float overlay = 0.5f;      // strength of false colors
    RenderSettings render{.samples = 1};
    std::string reference;       // path of a picture to compare with
    std::string shows = "image"; // image, reference, error
    bool operator==(const ImageState&) const = default;
};

struct StudioState {
    TraceState trace;
    ScriptState script;
    ViewState view;
    LoupeState loupe;
    ParallelState parallel;
    ScatterState scatter;
    HistogramState histogram;
    RelaxState relax;
    ImageState image;
    Ids selection;
    std::map<std::string, Ids> named; // selections by name
    bool operator==(const StudioState&) const = default;
};

// Whether what is rendered is to be relaxed.
inline bool shows_relaxed(const StudioState& state) {
    return state.view.shows_relaxed && state.relax.is_wanted();
}

} // namespace photonloupe::studio
