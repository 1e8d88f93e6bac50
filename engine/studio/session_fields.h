// SPDX-License-Identifier: Apache-2.0
// What a session holds, once for both directions: each field with its name and what it may be.
#pragma once

#include "studio/stage_choices.h"

namespace photonloupe::studio {

constexpr std::size_t LONGEST_TEXT = 1u << 20; // of a script, as the compiler takes it
constexpr std::size_t LONGEST_NAME = 256;
constexpr std::size_t LONGEST_ADDITION = 5000; // a path and what is told of a light
constexpr std::size_t MOST_ENTRIES = 256;
constexpr double LARGEST = 0x1p100; // a float too: rounding must not lead beyond it

template <class Archive>
void visit(Archive& archive, TraceState& trace) {
    archive.path("scene", trace.scene);
    archive.path("map", trace.map);
    archive.field("additions", trace.additions, MOST_ENTRIES, LONGEST_ADDITION);
    archive.settings(list_settings<TraceSettings>(trace));
}

template <class Archive>
void visit(Archive& archive, ScriptState& script) {
    archive.path("path", script.path);
    archive.field("text", script.text, LONGEST_TEXT);
    archive.field("ran", script.ran, LONGEST_TEXT);
    archive.field("values", script.values, LARGEST);
}

template <class Archive>
void visit(Archive& archive, CameraState& camera) {
    archive.field("is_set", camera.is_set);
    archive.field("target", camera.target, LARGEST);
    archive.field("yaw", camera.yaw, -1e3, 1e3);
    archive.field("pitch", camera.pitch, -1.6, 1.6);
    archive.field("distance", camera.distance, 1e-30, LARGEST);
    archive.field("yfov", camera.yfov, 1e-3, 3.0);
}

template <class Archive>
void visit(Archive& archive, ViewState& view) {
    archive.enumeration("mode", view.mode,
                        {"points", "voronoi", "kd_tree", "colored_points", "render", "colored_render", "map"}, 1);
    archive.member("camera", view.camera);
    archive.field("shows_relaxed", view.shows_relaxed);
    archive.field("is_split", view.is_split);
    archive.field("split_at", view.split_at, 0, 1);
    archive.field("point_size", view.point_size, 1, 16);
    archive.field("brightness", view.brightness, -20, 20);
    archive.field("tree_depth", view.tree_depth, -1, 64);
    archive.field("map_column", view.map_column, LONGEST_NAME);
}

template <class Archive>
void visit(Archive& archive, LoupeState& loupe) {
    archive.settings(list_settings<inspect::LoupeSettings>(loupe));
    archive.field("lock", loupe.lock, {"none", "pin", "brushes"});
    archive.field("has_point", loupe.has_point);
    archive.field("point", loupe.point, LARGEST);
    archive.field("pins", loupe.pins, 16);
    archive.field("shows_paths", loupe.shows_paths);
    archive.field("shows_drift", loupe.shows_drift);
    archive.field("numbers", loupe.numbers, MOST_ENTRIES, LONGEST_NAME);
}

template <class Archive>
void visit(Archive& archive, AxisState& axis) {
    archive.field("name", axis.name, LONGEST_NAME);
    archive.field("low", axis.low, -LARGEST, LARGEST);
    archive.field("high", axis.high, -LARGEST, LARGEST);
    archive.field("is_flipped", axis.is_flipped);
    archive.field("is_closed", axis.is_closed);
    archive.field("periods", axis.periods, 1, 64);
    archive.field("brushes", axis.brushes, MOST_ENTRIES, LARGEST);
}

template <class Archive>
void visit(Archive& archive, ParallelState& parallel) {
    archive.members("axes", parallel.axes, 32);
    archive.field("tension", parallel.tension, 0, 1);
    archive.field("source", parallel.source, {"loupe", "all", "selection"});
    archive.field("color", parallel.color, LONGEST_NAME);
    archive.field("shows_density", parallel.shows_density);
}

template <class Archive>
void visit(Archive& archive, ScatterState& scatter) {
    archive.field("x", scatter.x, LONGEST_NAME);
    archive.field("y", scatter.y, LONGEST_NAME);
    archive.field("is_polar", scatter.is_polar);
    archive.field("source", scatter.source, {"loupe", "all", "selection"});
    archive.field("shows_pair", scatter.shows_pair);
}

template <class Archive>
void visit(Archive& archive, HistogramState& histogram) {
    archive.field("column", histogram.column, LONGEST_NAME);
    archive.field("bins", histogram.bins, 1, 4096);
    archive.field("threshold", histogram.threshold, -LARGEST, LARGEST);
    archive.field("shows_cdf", histogram.shows_cdf);
}

template <class Archive>
void visit(Archive& archive, RelaxState& relax) {
    archive.member("choices", list_settings(relax.choices));
    archive.member("used", list_settings(relax.used));
    archive.field("made", relax.made, 0, MOST_STEPS);
    archive.field("is_measured", relax.is_measured);
}

template <class Archive>
void visit(Archive& archive, ImageState& image) {
    archive.field("exposure", image.exposure, -64, 64);
    archive.field("tone", image.tone, {"srgb", "filmic"});
    archive.field("overlay", image.overlay, 0, 1);
    archive.settings(list_choices(image));
    archive.path("reference", image.reference);
    archive.field("shows", image.shows, {"image", "reference", "error"});
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
