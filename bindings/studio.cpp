// SPDX-License-Identifier: Apache-2.0
// Binds engine/studio: the interactive tool, its input, its pictures, and the hand-over of work.
#include "binding.h"

#include <nanobind/stl/pair.h>

#include "core/cache_folder.h"
#include "studio/edit_state.h"
#include "studio/loupe_query.h"
#include "studio/python_script.h"
#include "studio/session.h"
#include "studio/studio.h"

namespace photonloupe::bindings {
namespace {

using studio::Workspace;

// Gives the GIL back when what was made after it is gone.
struct FreeState {
    PyThreadState* state = nullptr;
    ~FreeState() {
        if (state)
            PyEval_RestoreThread(state);
    }
};

// A studio that goes without the GIL: it waits for the device, which work that waits for the GIL may hold.
struct Studio : FreeState, studio::Studio {
    using studio::Studio::Studio;
    ~Studio() { state = PyEval_SaveThread(); }
};

std::unique_ptr<Studio> open_studio(OpenDevice& open, std::pair<std::uint32_t, std::uint32_t> size, float scale,
                                    bool is_offscreen) {
    nb::gil_scoped_release release;
    return std::make_unique<Studio>(open.device, studio::StudioOptions{size.first, size.second, scale, is_offscreen});
}

// Without the GIL: what waits for the device may wait for work that reports its progress to Python.
template <class Work>
auto run_free(const Work& work) {
    nb::gil_scoped_release release;
    return work();
}

nb::ndarray<nb::numpy, std::uint8_t, nb::ndim<3>> take_pixels(const std::vector<std::uint32_t>& pixels,
                                                              std::size_t width, std::size_t height) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * pixels.size());
    for (const std::uint32_t pixel : pixels)
        for (const int shift : {0, 8, 16})
            rgb.push_back(static_cast<std::uint8_t>(pixel >> shift));
    return own_pixels(std::move(rgb), height, width);
}

std::optional<std::array<float, 4>> describe_box(const std::optional<studio::WidgetBox>& box) {
    if (!box)
        return std::nullopt;
    return std::array{box->x, box->y, box->width, box->height};
}

std::optional<std::array<std::string, 3>> take_job(Studio& self) {
    const std::optional<studio::Job> job = self.take_job();
    if (!job)
        return std::nullopt;
    return std::array{job->kind, job->key, job->settings};
}

nb::object read_selection(Studio& self) {
    const studio::Ids ids = self.workspace().state.selection;
    if (!ids)
        return nb::none();
    return nb::cast(own_array(std::vector<std::uint32_t>(*ids)));
}

void select(Studio& self, std::optional<std::vector<std::uint32_t>> ids) {
    Workspace& workspace = self.workspace();
    workspace.change("select", [&](studio::StudioState& state) {
        for (studio::AxisState& axis : state.parallel.axes)
            axis.brushes.clear();
        workspace.select(ids ? std::make_shared<const std::vector<std::uint32_t>>(std::move(*ids)) : nullptr);
    });
}

void deliver_photons(Studio& self, std::shared_ptr<const Scene> scene, std::shared_ptr<Photons> photons,
                     bool has_same_paths) {
    run_free([&] { self.workspace().bench.build_view_trees(*photons); });
    self.deliver([scene = std::move(scene), photons = std::move(photons), has_same_paths](Workspace& workspace) {
        workspace.take_photons(scene, photons, has_same_paths);
    });
}

using StepRows = std::vector<std::array<double, 4>>;

std::vector<studio::StepResult> read_steps(const StepRows& rows) {
    std::vector<studio::StepResult> steps;
    for (const auto& row : rows)
        steps.push_back({row[0], row[1], row[2], row[3]});
    return steps;
}

void deliver_relaxed(Studio& self, std::shared_ptr<Photons> photons, const StepRows& rows,
                     std::optional<std::uint32_t> stopped_at) {
    run_free([&] { self.workspace().bench.build_view_trees(*photons); });
    self.deliver([photons = std::move(photons), steps = read_steps(rows), stopped_at](Workspace& workspace) {
        workspace.take_relaxed(photons, steps);
        if (stopped_at)
            workspace.state.relax.made = std::min(workspace.state.relax.made, *stopped_at);
    });
}

void deliver_isotropy(Studio& self, nb::ndarray<nb::numpy, const float, nb::ndim<1>, nb::c_contig> values, double beta,
                      double threshold) {
    studio::IsotropyResult result{{values.data(), values.data() + values.size()}, beta, threshold};
    self.deliver([result = std::move(result)](Workspace& workspace) { workspace.take_isotropy(result); });
}

void deliver_script(Studio& self, const nb::list& histograms, std::vector<std::string> prints,
                    std::vector<std::string> report, double milliseconds) {
    studio::ScriptResult result{{}, std::move(prints), std::move(report), milliseconds};
    for (nb::handle row : histograms)
        result.histograms.push_back({nb::cast<std::string>(row["name"]), nb::cast<double>(row["low"]),
                                     nb::cast<double>(row["high"]), nb::cast<std::vector<double>>(row["counts"])});
    self.deliver([result](Workspace& workspace) { workspace.results.script = result; });
}

using Pixels = nb::ndarray<nb::numpy, const float, nb::shape<-1, -1, 3>, nb::c_contig>;

std::optional<Image> take_image(const std::optional<Pixels>& pixels) {
    if (!pixels)
        return std::nullopt;
    return Image{static_cast<std::uint32_t>(pixels->shape(1)),
                 static_cast<std::uint32_t>(pixels->shape(0)),
                 std::vector<float>(pixels->data(), pixels->data() + pixels->size()),
                 {}};
}

void deliver_images(Studio& self, std::optional<Pixels> image, std::optional<Pixels> colors) {
    self.deliver([image = take_image(image), colors = take_image(colors)](Workspace& workspace) {
        workspace.results.image = image;
        workspace.results.colors = colors;
        ++workspace.results.image_version;
    });
}

void deliver_comparison(Studio& self, std::optional<Pixels> reference, std::optional<Pixels> error, double rmse,
                        double relmse, double flip) {
    self.deliver([=, reference = take_image(reference), error = take_image(error)](Workspace& workspace) {
        workspace.results.reference = reference;
        workspace.results.error = error;
        workspace.results.comparison.reset();
        if (error)
            workspace.results.comparison = studio::ComparisonResult{rmse, relmse, flip};
        ++workspace.results.image_version;
    });
}

void bind_input(nb::class_<Studio>& type) {
    type.def("move_mouse", &Studio::move_mouse)
        .def("press_mouse", &Studio::press_mouse)
        .def("turn_wheel", &Studio::turn_wheel)
        .def("press_key", &Studio::press_key)
        .def("hold_key", &Studio::hold_key)
        .def("type_text", &Studio::type_text)
        .def("drop_file", &Studio::drop_file)
        .def("command", &Studio::run_command, nb::call_guard<nb::gil_scoped_release>())
        .def("widget", [](const Studio& self, const std::string& name) { return describe_box(self.find_widget(name)); })
        .def("widgets", &Studio::list_widgets);
}

void bind_work(nb::class_<Studio>& type) {
    type.def("take_job", &take_job,
             "(kind, key, settings as JSON) of the next piece of work, once; None: there is none.")
        .def("end_job", [](Studio& self, const std::string& kind, const std::string& key,
                           const std::string& error) { self.end_job({kind, key, {}}, error); })
        .def("report_progress", &Studio::report_progress)
        .def("stop_job", &Studio::stop_job)
        .def("take_requests", &Studio::take_requests)
        .def("say", [](Studio& self, const std::string& text,
                       bool is_error) { self.deliver([=](Workspace& workspace) { workspace.say(text, is_error); }); })
        .def("deliver_photons", &deliver_photons, nb::arg("scene").none(), nb::arg("photons"),
             nb::arg("has_same_paths"))
        .def("deliver_relaxed", &deliver_relaxed, nb::arg("photons"), nb::arg("steps"), nb::arg("stopped_at").none())
        .def("deliver_steps",
             [](Studio& self, const StepRows& rows) {
                 self.deliver([steps = read_steps(rows)](Workspace& workspace) { workspace.results.steps = steps; });
             })
        .def("forget_script",
             [](Studio& self) { self.deliver([](Workspace& workspace) { workspace.results.script.reset(); }); })
        .def("deliver_isotropy", &deliver_isotropy)
        .def("deliver_script", &deliver_script)
        .def("forget_work", &Studio::forget_work)
        .def("deliver_images", &deliver_images, nb::arg("image").none(), nb::arg("colors").none())
        .def("deliver_comparison", &deliver_comparison, nb::arg("reference").none(), nb::arg("error").none(),
             nb::arg("rmse"), nb::arg("relmse"), nb::arg("flip"))
        .def("offer_restore",
             [](Studio& self, const std::string& path) {
                 self.deliver([=](Workspace& workspace) { workspace.restorable = path; });
             })
        .def("deliver_times",
             [](Studio& self, std::map<std::string, double> milliseconds) {
                 self.deliver([=](Workspace& workspace) { workspace.stage_milliseconds = milliseconds; });
             })
        .def("deliver_examples", [](Studio& self, const std::vector<std::pair<std::string, std::string>>& examples) {
            self.deliver([=](Workspace& workspace) {
                workspace.examples.clear();
                for (const auto& [path, text] : examples)
                    workspace.examples.push_back({path, text});
            });
        });
}

void bind_state(nb::class_<Studio>& type) {
    type.def("state", [](Studio& self) { return studio::write_state(self.workspace().state, {}); })
        .def("set_state", [](Studio& self, const std::string& name,
                             const std::string& text) { self.set_state(name, studio::read_state(text, {})); })
        .def("save_session",
             [](Studio& self, const std::string& path) { studio::save_session(path, self.workspace().state); })
        .def("load_session",
             [](Studio& self, const std::string& path) { self.set_state("open session", studio::load_session(path)); })
        .def(
            "python", [](Studio& self) { return studio::write_program(self.workspace()); },
            nb::call_guard<nb::gil_scoped_release>())
        .def(
            "complete_state",
            [](Studio& self) { return studio::write_state(studio::complete_state(self.workspace()), {}); },
            nb::call_guard<nb::gil_scoped_release>())
        .def("message",
             [](Studio& self) { return std::pair(self.workspace().message, self.workspace().message_is_error); })
        .def("look_at",
             [](Studio& self, const std::array<double, 3>& point) {
                 studio::move_loupe(self.workspace(), point, std::nullopt);
             })
        .def("loupe_ids",
             [](Studio& self) {
                 const auto& loupe = self.workspace().loupe;
                 return own_array(loupe ? std::vector<std::uint32_t>(loupe->ids) : std::vector<std::uint32_t>{});
             })
        .def(
            "paths",
            [](const Studio& self) {
                const studio::StudioState& state = self.workspace().state;
                return std::pair(state.trace.scene, state.script.path);
            },
            "Scene and script; empty: none.")
        .def("has_relaxed", [](const Studio& self) { return self.workspace().has_relaxed(); })
        .def("version", [](Studio& self) { return self.workspace().selection_version; })
        .def("selection", &read_selection)
        .def("select", &select, nb::arg("ids").none());
}

} // namespace

void bind_studio(nb::module_& module) {
    nb::class_<Studio> type(module, "Studio");
    type.def("frame", &Studio::frame, nb::call_guard<nb::gil_scoped_release>())
        .def("wait", &Studio::wait, nb::call_guard<nb::gil_scoped_release>())
        .def("hide", &Studio::hide)
        .def_prop_ro("should_close", &Studio::should_close)
        .def_prop_ro("size", [](const Studio& self) { return std::pair(self.width(), self.height()); })
        .def("image",
             [](Studio& self) {
                 return take_pixels(run_free([&] { return self.read_image(); }), self.width(), self.height());
             })
        .def("panel",
             [](Studio& self, const std::string& name, std::uint32_t width, std::uint32_t height, float scale) {
                 return take_pixels(run_free([&] { return self.read_panel(name, width, height, scale); }), width,
                                    height);
             })
        .def("resize", &Studio::resize, nb::call_guard<nb::gil_scoped_release>())
        .def("statistics", [](Studio& self) {
            studio::FrameStatistics taken = self.take_statistics();
            nb::dict row;
            row["frames"] = own_array(std::move(taken.frames));
            row["loupe"] = own_array(std::move(taken.loupe));
            row["plots"] = own_array(std::move(taken.plots));
            return row;
        });
    bind_input(type);
    bind_work(type);
    bind_state(type);
    module.def("open_studio", &open_studio, nb::arg("device"), nb::arg("size"), nb::arg("scale"), nb::arg("offscreen"),
               nb::keep_alive<0, 1>(), "The interactive tool, in a window or without.");
    module.def(
        "find_cache_folder", [] { return find_cache_folder().string(); },
        "The per-user folder for what can be made again; empty: there is none.");
    module.def("list_studio_commands", [] {
        nb::list rows;
        for (const studio::Command& command : studio::list_commands())
            rows.append(
                nb::make_tuple(std::string(command.name), std::string(command.keys), std::string(command.about)));
        return rows;
    });
}

} // namespace photonloupe::bindings
