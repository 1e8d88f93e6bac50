// SPDX-License-Identifier: Apache-2.0
// Binds engine/studio: the interactive tool, its input, its pictures, and the hand-over of work.
#include "binding.h"

#include "core/cache_folder.h"
#include "settings.h"
#include "studio/edit_state.h"
#include "studio/loupe_query.h"
#include "studio/python_script.h"
#include "studio/session.h"
#include "studio/worker.h"

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

// Python's part of the work, from any thread; what it raises is said by the interface.
class PythonHost {
public:
    PythonHost(nb::object load_map, nb::object compare)
        : m_load_map(keep(std::move(load_map))), m_compare(keep(std::move(compare))) {}

    studio::Host make() const {
        return {
            [load = m_load_map](const std::string& path) {
                return ask<studio::LoadedMap>([&] {
                    auto [origin, photons, scene, remarks] =
                        nb::cast<std::tuple<nb::object, std::shared_ptr<Photons>, std::optional<std::shared_ptr<Scene>>,
                                            std::vector<std::string>>>((*load)(path));
                    return studio::LoadedMap{keep(std::move(origin)), photons, scene.value_or(nullptr), remarks};
                });
            },
            [compare = m_compare](const Image& image, const std::string& reference) {
                return ask<studio::Comparison>([&] {
                    const auto [pixels, error, rmse, relmse, flip, reason] =
                        nb::cast<std::tuple<Pixels, std::optional<Pixels>, double, double, double, std::string>>((
                            *compare)(own_pixels(std::vector<float>(image.rgb), image.height, image.width), reference));
                    studio::Comparison comparison{take_image(pixels), {}, {rmse, relmse, flip}, reason};
                    if (error)
                        comparison.error = take_image(*error);
                    return comparison;
                });
            }};
    }

private:
    using Kept = std::shared_ptr<nb::object>; // may go without the GIL

    static Kept keep(nb::object function) {
        return Kept(new nb::object(std::move(function)), [](nb::object* kept) {
            nb::gil_scoped_acquire acquire;
            delete kept;
        });
    }

    template <class Answer, class Call>
    static Answer ask(const Call& call) {
        nb::gil_scoped_acquire acquire;
        try {
            return call();
        } catch (const nb::python_error& error) {
            if (!error.matches(PyExc_Exception)) { // Ctrl-C: for whoever waits for the work
                PyErr_SetInterrupt();
                throw Cancelled("stopped on request");
            }
            const std::string text = nb::str(error.value()).c_str();
            throw Error(text.empty() ? nb::type_name(error.type()).c_str() : text);
        }
    }

    Kept m_load_map, m_compare;
};

// A studio with its worker, that goes without the GIL: it waits for the device, and for work that may ask Python.
struct Studio : FreeState, studio::Studio {
    std::optional<studio::Worker> worker; // goes first
    using studio::Studio::Studio;
    ~Studio() { state = PyEval_SaveThread(); }
};

std::unique_ptr<Studio> open_studio(OpenDevice& open, std::pair<std::uint32_t, std::uint32_t> size, float scale,
                                    bool is_offscreen, bool is_threaded, nb::object load_map, nb::object compare) {
    const studio::Host host = PythonHost(std::move(load_map), std::move(compare)).make();
    nb::gil_scoped_release release;
    auto opened =
        std::make_unique<Studio>(open.workbench, studio::StudioOptions{size.first, size.second, scale, is_offscreen});
    opened->worker.emplace(*opened, host, is_threaded);
    return opened;
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

nb::object read_selection(Studio& self) {
    const studio::Ids ids = self.workspace().state.selection;
    if (!ids)
        return nb::none();
    return nb::cast(own_array(std::vector<std::uint32_t>(*ids)));
}

void select(Studio& self, std::optional<std::vector<std::uint32_t>> ids) {
    studio::select_instead(self.workspace(), "select",
                           ids ? std::make_shared<const std::vector<std::uint32_t>>(std::move(*ids)) : nullptr);
}

nb::object describe_trace(const std::optional<TraceSettings>& trace) {
    if (!trace)
        return nb::none();
    TraceSettings settings = *trace;
    nb::dict row = write_rows(list_settings(settings));
    row["paths"] = settings.paths;
    return std::move(row);
}

nb::object describe_script(const studio::Made& made) {
    if (!made.script)
        return nb::none();
    return make_row("name"_a = made.script_name, "hash"_a = made.script_hash, "values"_a = made.script->exposed,
                    "seed"_a = script::RunSettings().seed, "keep"_a = false);
}

nb::dict describe_made(const Studio& self) {
    const studio::Made made = self.worker->stages().made();
    return make_row("scene"_a = std::const_pointer_cast<Scene>(made.scene), "photons"_a = made.photons,
                    "trace"_a = describe_trace(made.trace),
                    "origin"_a = made.origin ? *std::static_pointer_cast<nb::object>(made.origin) : nb::none(),
                    "script"_a = describe_script(made), "relaxed"_a = made.relaxed,
                    "relaxation"_a = made.relaxed ? nb::object(describe_relaxation(made.relaxation)) : nb::none());
}

using Rendered = std::tuple<nb::ndarray<nb::numpy, float, nb::ndim<3>>, nb::dict, bool>;

std::optional<Rendered> describe_rendered(const Studio& self) {
    const studio::Made made = self.worker->stages().made();
    if (!made.image)
        return std::nullopt;
    RenderSettings settings = made.render;
    nb::dict told = write_rows(list_settings(settings)), camera;
    camera["position"] = made.camera.position;
    camera["target"] = made.camera.target;
    camera["up"] = made.camera.up;
    camera["yfov"] = made.camera.yfov;
    told["camera"] = camera;
    return Rendered(own_pixels(std::vector<float>(made.image->rgb), made.image->height, made.image->width), told,
                    made.is_relaxed);
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
    type.def(
            "take_turn",
            [](Studio& self) {
                PythonProgress progress{nb::object(nb::none())};
                const bool is_done = progress.run([&](const Progress& asked) { return self.worker->take_turn(asked); });
                progress.raise();
                return is_done;
            },
            "Begin the next job; True: it has been done, and a frame should show it.")
        .def_prop_ro("is_busy", [](const Studio& self) { return self.worker->is_busy(); })
        .def_prop_ro(
            "job_counts", [](const Studio& self) { return self.worker->counts(); }, "Jobs begun, by kind.")
        .def(
            "close", [](Studio& self) { self.worker->close(); }, nb::call_guard<nb::gil_scoped_release>())
        .def("stop_job", &Studio::stop_job)
        .def("open_scene", [](Studio& self, std::shared_ptr<Scene> scene) { self.worker->stages().open_scene(scene); })
        .def("made", &describe_made,
             "scene, photons, trace (settings; None: from a file), origin (what load_map gave), script, relaxed, "
             "relaxation; None where there is "
             "none.")
        .def("rendered", &describe_rendered,
             "The last rendered view, its settings, and whether its photons are relaxed.")
        .def("take_requests", &Studio::take_requests)
        .def("say", [](Studio& self, const std::string& text,
                       bool is_error) { self.deliver([=](Workspace& workspace) { workspace.say(text, is_error); }); })
        .def("forget_work", &Studio::forget_work)
        .def("offer_restore",
             [](Studio& self, const std::string& path) {
                 self.deliver([=](Workspace& workspace) { workspace.restorable = path; });
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
        .def("select", &select, "ids"_a.none());
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
            return make_row("frames"_a = own_array(std::move(taken.frames)),
                            "loupe"_a = own_array(std::move(taken.loupe)),
                            "plots"_a = own_array(std::move(taken.plots)));
        });
    bind_input(type);
    bind_work(type);
    bind_state(type);
    module.def("open_studio", &open_studio, "device"_a, "size"_a, "scale"_a, "offscreen"_a, "threaded"_a, "load_map"_a,
               "compare"_a, nb::keep_alive<0, 1>(),
               "The interactive tool, in a window or without, that works in a thread or in its frames. "
               "load_map(path): what is kept of it, the map, its scene or None, remarks. compare(pixels, path): "
               "reference, error map or "
               "None, rmse, relmse, flip, and why there is none.");
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
