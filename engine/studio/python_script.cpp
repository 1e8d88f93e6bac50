// SPDX-License-Identifier: Apache-2.0
// Writes the state as a Python program; what stands at its default is left out.
#include "studio/python_script.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "studio/camera.h"
#include "studio/stage_choices.h"

namespace photonloupe::studio {
namespace {

using Text = nlohmann::json;

// A Python literal: JSON's strings and numbers are Python's too.
std::string quote(const std::string& text) {
    return Text(text).dump(-1, ' ', true, Text::error_handler_t::replace);
}
std::string write(double value) {
    return Text(value).dump();
}
std::string write(float value) {
    return Text(value).dump(); // shortest text that reads back as this float
}
std::string write(bool value) {
    return value ? "True" : "False";
}
template <class T, std::size_t Size>
std::string write(const std::array<T, Size>& values) {
    std::string text;
    for (const T value : values)
        text += (text.empty() ? "(" : ", ") + write(value);
    return text + ")";
}

std::string write(const Setting& setting) {
    const SettingValue value = setting.read(setting);
    if (std::holds_alternative<std::monostate>(value))
        return setting.about.empty == "auto" ? quote("auto") : "None";
    if (const auto* flag = std::get_if<bool>(&value))
        return write(*flag);
    if (const auto* name = std::get_if<std::string>(&value))
        return quote(*name);
    return setting.kind == SettingKind::numbers ? "(" + write_text(value) + ")" : write_text(value);
}

// What differs from the defaults, as further arguments of a call.
std::string write_arguments(const std::vector<Setting>& settings, const std::vector<Setting>& defaults) {
    std::string text;
    for (std::size_t i = 0; i < settings.size(); ++i)
        if (settings[i].read(settings[i]) != defaults[i].read(defaults[i]))
            text += ", " + settings[i].about.name + "=" + write(settings[i]);
    return text;
}

template <class Settings>
std::string write_arguments(Settings& settings) {
    Settings defaults;
    return write_arguments(list_settings(settings), list_settings(defaults));
}

// Raw, where the text allows it, so that a script stays readable.
std::string write_script(const std::string& text) {
    const bool is_plain = text.find("'''") == std::string::npos && text.find('\r') == std::string::npos &&
                          (text.empty() || (text.back() != '\'' && text.back() != '\\'));
    const bool is_one_path = text.find('\n') == std::string::npos && text.ends_with(".photon");
    return is_plain && !is_one_path ? "r'''" + text + "'''" : quote(text);
}

// What is added, as the call that adds it; what no call takes is left out.
std::string write_addition(const std::string& addition) {
    const Text told = Text::parse(addition, nullptr, false);
    const auto find = [&](const char* name) { return told.is_object() && told.contains(name) ? told[name] : Text(); };
    const bool is_light = find("add") == "light";
    if (!is_light && find("add") != "floor") // the time, which loading has told
        return "";
    std::string arguments = is_light && find("kind").is_string() ? quote(find("kind").get<std::string>()) : "";
    if (const Text image = find("image"); image.is_string())
        arguments += (arguments.empty() ? "image=" : ", image=") + quote(image.get<std::string>());
    for (const char* name : {"rotation", "position", "direction", "intensity", "color", "size", "cone", "y"})
        if (const Text value = find(name); value.is_number() || value.is_array())
            arguments += (arguments.empty() ? "" : ", ") + std::string(name) + "=" + value.dump();
    return (is_light ? "scene.add_light(" : "scene.add_floor(") + arguments + ")\n";
}

// The first addition may say where an animation has things.
std::string write_time(const std::vector<std::string>& additions) {
    const Text told = additions.empty() ? Text() : Text::parse(additions.front(), nullptr, false);
    const bool is_time =
        told.is_object() && told.value("add", Text()) == "time" && told.value("time", Text()).is_number();
    return is_time ? ", time=" + told["time"].dump() : "";
}

std::string write_trace(const TraceState& trace) {
    std::string text;
    if (!trace.scene.empty()) {
        text += "scene = pl.load_scene(" + quote(trace.scene) + write_time(trace.additions) + ")\n";
        for (const std::string& addition : trace.additions)
            text += write_addition(addition);
    }
    if (!trace.map.empty())
        return text + "photons = pl.load_photons(" + quote(trace.map) + ")\n";
    TraceState copy = trace;
    return text + "photons = pl.trace_photons(scene" + write_arguments<TraceSettings>(copy) + ")\n";
}

std::string write_run(const ScriptState& script) {
    if (script.ran.empty())
        return "";
    std::string values;
    for (const auto& [name, value] : script.values)
        values += (values.empty() ? "" : ", ") + quote(name) + ": " + write(value);
    return "photons.run_script(\n    " + write_script(script.ran) + ",\n    values={" + values + "},\n)\n";
}

std::string write_relax(const RelaxState& relax) {
    if (relax.made == 0 && !relax.is_measured)
        return "relaxed = photons\n";
    RelaxSettings used = relax.used;
    return "relaxation = pl.Relaxation(photons" + write_arguments(used) + ")\nfor _ in range(" +
           std::to_string(relax.made) + "):\n    relaxation.step()\nrelaxed = relaxation.photons\n";
}

std::string write_render(const StudioState& state) {
    if (state.trace.scene.empty())
        return "";
    const CameraPose pose = find_pose(state.view.camera);
    const bool is_colored = state.view.mode == ViewMode::colored_render;
    ImageState image = state.image, defaults;
    defaults.render = {};
    return "camera = pl.Camera(position=" + write(pose.position) + ", target=" + write(pose.target) +
           ", up=" + write(pose.up) + ", yfov=" + write(pose.yfov) + ")\nimage = pl.render(\n    scene, " +
           (state.view.shows_relaxed ? "relaxed" : "photons") +
           ", camera=camera, width=" + std::to_string(RENDER_WIDTH) + ", height=" + std::to_string(RENDER_HEIGHT) +
           write_arguments(list_choices(image), list_choices(defaults)) +
           ", mode=" + (is_colored ? "\"false-color\"" : "\"composite\"") + ",\n)\nimage.save(\"view.exr\")\n";
}

std::string write_axis(const AxisState& axis) {
    std::string text = "    pl.inspect.Axis(" + quote(axis.name);
    if (axis.low != axis.high)
        text += ", low=" + write(axis.low) + ", high=" + write(axis.high);
    if (axis.is_closed)
        text += ", closed=True, periods=" + std::to_string(axis.periods);
    if (axis.is_flipped)
        text += ", flipped=True";
    std::string brushes;
    for (const std::array<float, 2>& brush : axis.brushes)
        brushes += write(brush) + ", ";
    return text + (brushes.empty() ? "" : ", brush=[" + brushes + "]") + "),\n";
}

// The brushes of the parameters, the first of each axis.
std::string write_ranges(const ParallelState& parallel, const std::vector<std::string>& parameters) {
    std::string text;
    for (const AxisState& axis : parallel.axes)
        if (!axis.brushes.empty() && std::find(parameters.begin(), parameters.end(), axis.name) != parameters.end())
            text += (text.empty() ? "" : ", ") + quote(axis.name) + ": " + write(axis.brushes.front());
    return text;
}

// The map in view.
std::string name_shown(const StudioState& state) {
    return state.view.shows_relaxed ? "relaxed" : "photons";
}

std::string write_loupe(const StudioState& state, const std::vector<std::string>& parameters) {
    const LoupeState& loupe = state.loupe;
    LoupeState copy = loupe;
    if (!loupe.has_point)
        return "";
    std::string text = "view = pl.inspect.loupe(\n    " + name_shown(state) + ", " + write(loupe.point) +
                       write_arguments<inspect::LoupeSettings>(copy);
    if (loupe.space != SearchSpace::constrained)
        return text + ",\n)\n"; // the others have no range to lock
    if (loupe.lock == "pin" && !loupe.pins.empty())
        text += ", center=" + std::to_string(loupe.pins.back());
    if (const std::string ranges = write_ranges(state.parallel, parameters); loupe.lock == "brushes" && !ranges.empty())
        text += ", ranges={" + ranges + "}";
    return text + ",\n)\n";
}

std::string write_plot(const StudioState& state) {
    const ParallelState& parallel = state.parallel;
    if (parallel.axes.empty())
        return "";
    std::string text = "axes = [\n";
    for (const AxisState& axis : parallel.axes)
        text += write_axis(axis);
    const bool uses_loupe = parallel.source == "loupe" && state.loupe.has_point;
    return text + "]\nplot = pl.inspect.parallel_coordinates(" + name_shown(state) + ", axes, " +
           (uses_loupe ? "selection=view.ids, " : "") + "tension=" + write(parallel.tension) + ")\n";
}

} // namespace

std::string write_python(const StudioState& state, const std::vector<std::string>& parameters) {
    if (state.trace.scene.empty() && state.trace.map.empty())
        return "import photonloupe as pl\n";
    return "import photonloupe as pl\n\n" + write_trace(state.trace) + write_run(state.script) +
           write_relax(state.relax) + write_render(state) + write_loupe(state, parameters) + write_plot(state);
}

} // namespace photonloupe::studio
