// SPDX-License-Identifier: Apache-2.0
// What a session holds, once for both directions: each field with its name and what it may be.
#pragma once

#include "studio/stage_choices.h"

namespace photonloupe::studio {

constexpr std::size_t LONGEST_TEXT = 1u << 20; // of a script, as the compiler takes it
constexpr std::size_t LONGEST_NAME = 256;
constexpr std::size_t MOST_ENTRIES = 256;
constexpr double LARGEST = 0x1p100; // a float too: rounding must not lead beyond it

template <class Archive>
void visit(Archive& archive, TraceState& trace) {
    archive.path("scene", trace.scene);
    archive.path("map", trace.map);
    archive.settings(list_settings<TraceSettings>(trace));
}

template <class Archive>
void visit(Archive& archive, ScriptState& script) {
    archive.path("path", script.path);
    archive.text("text", script.text, LONGEST_TEXT);
    archive.text("ran", script.ran, LONGEST_TEXT);
    archive.numbers_by_name("values", script.values, LARGEST);
}

template <class Archive>
void visit(Archive& archive, CameraState& camera) {
    archive.flag("is_set", camera.is_set);
    archive.array("target", camera.target, LARGEST);
    archive.number("yaw", camera.yaw, -1e3, 1e3);
    archive.number("pitch", camera.pitch, -1.6, 1.6);
    archive.number("distance", camera.distance, 1e-30, LARGEST);
    archive.number("yfov", camera.yfov, 1e-3, 3.0);
}

template <class Archive>
void visit(Archive& archive, ViewState& view) {
    archive.enumeration("mode", view.mode,
                        {"points", "voronoi", "kd_tree", "colored_points", "render", "colored_render", "map"}, 1);
    archive.member("camera", view.camera);
    archive.flag("shows_relaxed", view.shows_relaxed);
    archive.flag("is_split", view.is_split);
    archive.number("split_at", view.split_at, 0, 1);
    archive.number("point_size", view.point_size, 1, 16);
    archive.number("brightness", view.brightness, -20, 20);
    archive.number("tree_depth", view.tree_depth, -1, 64);
    archive.text("map_column", view.map_column, LONGEST_NAME);
}

template <class Archive>
void visit(Archive& archive, LoupeState& loupe) {
    archive.settings(list_settings<inspect::LoupeSettings>(loupe));
    archive.choice("lock", loupe.lock, {"none", "pin", "brushes"});
    archive.flag("has_point", loupe.has_point);
    archive.array("point", loupe.point, LARGEST);
    archive.whole_numbers("pins", loupe.pins, 16);
    archive.flag("shows_paths", loupe.shows_paths);
    archive.flag("shows_drift", loupe.shows_drift);
    archive.texts("numbers", loupe.numbers, MOST_ENTRIES, LONGEST_NAME);
}

template <class Archive>
void visit(Archive& archive, AxisState& axis) {
    archive.text("name", axis.name, LONGEST_NAME);
    archive.number("low", axis.low, -LARGEST, LARGEST);
    archive.number("high", axis.high, -LARGEST, LARGEST);
    archive.flag("is_flipped", axis.is_flipped);
    archive.flag("is_closed", axis.is_closed);
    archive.number("periods", axis.periods, 1, 64);
    archive.intervals("brushes", axis.brushes, MOST_ENTRIES, LARGEST);
}

template <class Archive>
void visit(Archive& archive, ParallelState& parallel) {
    archive.members("axes", parallel.axes, 32);
    archive.number("tension", parallel.tension, 0, 1);
    archive.choice("source", parallel.source, {"loupe", "all", "selection"});
    archive.text("color", parallel.color, LONGEST_NAME);
    archive.flag("shows_density", parallel.shows_density);
}

template <class Archive>
void visit(Archive& archive, ScatterState& scatter) {
    archive.text("x", scatter.x, LONGEST_NAME);
    archive.text("y", scatter.y, LONGEST_NAME);
    archive.flag("is_polar", scatter.is_polar);
    archive.choice("source", scatter.source, {"loupe", "all", "selection"});
    archive.flag("shows_pair", scatter.shows_pair);
}

template <class Archive>
void visit(Archive& archive, HistogramState& histogram) {
    archive.text("column", histogram.column, LONGEST_NAME);
    archive.number("bins", histogram.bins, 1, 4096);
    archive.number("threshold", histogram.threshold, -LARGEST, LARGEST);
    archive.flag("shows_cdf", histogram.shows_cdf);
}

template <class Archive>
void visit(Archive& archive, RelaxState& relax) {
    archive.member("choices", list_settings(relax.choices));
    archive.member("used", list_settings(relax.used));
    archive.number("made", relax.made, 0, MOST_STEPS);
    archive.flag("is_measured", relax.is_measured);
}

template <class Archive>
void visit(Archive& archive, ImageState& image) {
    archive.number("exposure", image.exposure, -64, 64);
    archive.choice("tone", image.tone, {"srgb", "filmic"});
    archive.number("overlay", image.overlay, 0, 1);
    archive.settings(list_choices(image));
    archive.path("reference", image.reference);
    archive.choice("shows", image.shows, {"image", "reference", "error"});
}

template <class Archive>
void visit(Archive& archive, StudioState& state) {
    archive.member("trace", state.trace);
    archive.member("script", state.script);
    archive.member("view", state.view);
    archive.member("loupe", state.loupe);
    archive.member("parallel", state.parallel);
    archive.member("scatter", state.scatter);
    archive.member("histogram", state.histogram);
    archive.member("relax", state.relax);
    archive.member("image", state.image);
    archive.ids("selection", state.selection);
    archive.ids_by_name("named", state.named, MOST_ENTRIES, LONGEST_NAME);
}

} // namespace photonloupe::studio
