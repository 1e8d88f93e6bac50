// SPDX-License-Identifier: Apache-2.0
// What all panels share: the state, its results, what is cached of them, and how changes are made.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "inspect/columns/columns.h"
#include "inspect/loupe.h"
#include "studio/camera.h"
#include "studio/fonts.h"
#include "studio/history.h"
#include "studio/results.h"
#include "studio/script_document.h"
#include "studio/show_pixels.h"
#include "studio/work.h"

namespace photonloupe::studio {

// Where a widget was drawn last, pixels of the window.
struct WidgetBox {
    float x = 0, y = 0, width = 0, height = 0;
};

// A script to begin with.
struct ExampleScript {
    std::string path;
    std::string text;
};

// What stands in the fields of menus.
struct ExportMenu {
    std::string selection_name;
    std::string panel = "View";
    std::array<int, 2> size{1200, 800};
    float scale = 1.5f;
    std::string path;
};

// The work in progress, as the status line shows it.
struct Activity {
    bool is_running = false;
    bool is_stopping = false;
    std::string stage;
    double fraction = 0;
};

struct Workspace {
    explicit Workspace(Workbench& stages) : device(stages.device()), bench(stages), pixels(device) {}

    gpu::Device& device;
    Workbench& bench;
    StudioState state;
    History history;
    Results results;
    DoneWork done;
    std::map<std::string, std::string> failed; // kinds of work that went wrong, and how
    Activity activity;
    ScriptDocument script;
    std::vector<ExampleScript> examples;
    Fonts fonts;
    PixelShow pixels;          // images of panels
    bool is_offscreen = false; // fixed clock, no timings shown, nothing blinks
    float scale = 1.0f;        // of the monitor
    std::uint64_t frame = 0;
    double frame_milliseconds = 0;
    std::vector<double> loupe_times, plot_times;      // milliseconds, of this frame
    std::map<std::string, double> stage_milliseconds; // of the last work
    ExportMenu menus;
    std::string restorable; // a session that a crash left; empty: none
    std::string open_path;  // in the status line's field
    std::string message;    // the last thing that went wrong, or right; empty: none
    bool message_is_error = false;
    bool wants_render = false;   // the Image panel's
    bool wants_isotropy = false; // whoever asked for the column
    bool shows_keys = false;
    std::string focus = "Relaxation"; // a panel to bring to the front; empty: none
    std::string solo;                 // the only panel, filling the window: exports; empty: all
    bool is_settled = true;           // views have nothing left to refine

    std::optional<inspect::LoupeView> loupe; // what it sees now
    std::string loupe_missing;               // why it sees nothing
    std::map<std::uint32_t, inspect::LoupeView> pinned;
    std::optional<glm::vec3> loupe_normal;  // of the surface under the cursor
    std::uint64_t loupe_version = 0;        // rises when what it is asked changes
    std::uint64_t loupe_result_version = 0; // rises when `loupe` changes
    std::string loupe_key;                  // of what `loupe` was asked
    std::uint64_t selection_version = 0;

    std::map<std::string, WidgetBox> widgets;
    std::vector<std::string> requests; // of files and sessions: for whoever owns them ("save_session PATH" …)

    // The photons in view: relaxed ones where they are wanted and there. Null: none yet.
    Photons* shown() const;
    Photons* shown(bool relaxed) const;
    bool has_relaxed() const { return results.relaxed != nullptr; }
    // What the state no longer asks for goes: relaxed photons after a reset or an undo.
    void drop_unwanted();
    bool has_parameters() const { return results.photons && results.photons->map.parameters.has_value(); }

    // A command: changes the state and goes into the history under its name, if there was anything to change.
    template <class Change>
    void change(const std::string& name, const Change& make) {
        const StudioState before = state;
        make(state);
        if (!(state == before))
            history.record(name, before);
    }
    void say(std::string text, bool is_error = false) {
        message = std::move(text);
        message_is_error = is_error;
    }

    // A column of the photons in view, or of those given, computed once. Throws Error as find_column does.
    const inspect::Column& find_column(const std::string& name, Photons* photons = nullptr);
    // The same, or null with what to do in `missing`.
    const inspect::Column* seek_column(const std::string& name, std::string* missing = nullptr,
                                       Photons* photons = nullptr);
    const std::vector<inspect::ColumnInfo>& list_columns();
    // What columns call the parameters, in their order.
    const std::vector<std::string>& list_parameters();
    // Why something is not there yet: the work is under way (`waiting`), or it went wrong.
    std::string explain_wait(const std::string& kind, const char* waiting) const;
    // sRGB colors of photons, by id: the script's encoding, or a column through a color map. Empty: grey.
    const std::vector<std::uint32_t>& find_colors(const std::string& name, Photons* photons = nullptr);

    // Selects; null: nothing. Not a command: `change` calls it.
    void select(Ids ids);
    // The photons a view plots: "loupe", "all" or "selection". Null with `all`.
    Ids find_source(const std::string& source);

    // What work has given. With `has_same_paths` they are those in view, of which a script changed the parameters
    // alone.
    void take_photons(std::shared_ptr<const Scene> scene, std::shared_ptr<Photons> photons,
                      bool has_same_paths = false);
    void take_relaxed(std::shared_ptr<Photons> photons, std::vector<StepResult> steps);

    void take_isotropy(IsotropyResult isotropy);
    // Ids that the map does not have leave selections and pins: of sessions of another map.
    void drop_unknown_ids();

private:
    void drop_caches(); // after photons changed

    struct ColumnKey {
        const Photons* photons;
        std::string name;
        auto operator<=>(const ColumnKey&) const = default;
    };
    using Columns = std::map<ColumnKey, inspect::Column>;
    // Of the photons in view, those that do not depend on parameters.
    Columns take_lasting_columns(const Photons* next);

    Columns m_columns;
    std::map<ColumnKey, std::vector<std::uint32_t>> m_colors;
    std::map<const Photons*, std::vector<inspect::ColumnInfo>> m_infos;
    std::map<const Photons*, std::vector<std::string>> m_parameters;
};

} // namespace photonloupe::studio
