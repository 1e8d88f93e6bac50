// SPDX-License-Identifier: Apache-2.0
// The one table of predefined calls: checker, planner, emitter, interpreter, completion, hover text and manual read it.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "script/program.h"

namespace photonloupe::script {

// Predefined calls that some stage tells apart. getNumVertices is a second name of getNumPathVertices, …Color… of
// …Colour…: one id each.
enum class BuiltinId : std::uint8_t {
    get_num_photons,
    get_photon_position,
    get_photon_normal,
    get_photon_power,
    get_photon_emitter,
    get_photon_parameter,
    get_num_path_vertices,
    get_path_vertex,
    get_path_normal,
    get_path_interaction,
    get_path_object,
    get_knn,
    get_parameter_knn,
    get_constrained_knn,
    length,
    declare_photon_parameter,
    set_photon_parameter,
    set_photon_colour_encoding,
    reset_pca_2d,
    push_pca_2d,
    decompose_pca_2d,
    reset_pca_3d,
    push_pca_3d,
    decompose_pca_3d,
    get_pca_eigenvalue,
    get_pca_eigenvector,
    get_pca_mean,
    histogram,
    print,
    int_,
    floor,
    ceil,
    round,
    mod,
    min,
    max,
    clamp,
    pow,
    random,
    dot,
    other, // every further one
};

// PCA of points in the plane.
constexpr bool is_planar(BuiltinId id) {
    return id == BuiltinId::reset_pca_2d || id == BuiltinId::push_pca_2d || id == BuiltinId::decompose_pca_2d;
}

// What a call needs or does, beyond its value.
enum class Effect : std::uint8_t {
    none,           // a value of its arguments alone
    reads_photon,   // the photon map's columns
    queries,        // neighbours
    sets_photon,    // setPhotonParameter, setPhotonColourEncoding
    declares,       // declarePhotonParameter
    changes_pca,    // reset, push
    decomposes_pca, // reads the moments, writes the decomposition
    reads_pca,      // the decomposition
    reports,        // histogram, print
};

// What an argument means, so that ranges and uniformity are checked in one place.
// An item is a whole number without bounds of its own.
enum class Argument : std::uint8_t {
    number,
    photon,
    axis,
    channel,
    vertex,
    dimension,
    list,
    text,
    uniform_number,
    uniform_count,
    bin_count,
    flag,
    item,
};

// How the result's type follows: `as_arguments` is integer when all number arguments are.
enum class Result : std::uint8_t { none, integer, real, list, as_arguments };

struct Builtin {
    std::string_view name; // as scripts write it
    BuiltinId id;
    std::string_view signature; // "getPathVertex(photon, vertex, axis)"
    std::string_view group;     // the manual's heading: "photons", "paths", …
    std::string_view doc;       // one line: meaning, units, what happens out of range
    std::span<const Argument> arguments;
    std::uint8_t required = 0; // arguments that must be given; the rest may be left out
    bool variadic = false;     // print: any number of further numbers
    Result result = Result::none;
    Effect effect = Effect::none;
    std::uint32_t columns = 0; // Columns it reads (program.h)
    std::string_view glsl;     // function of shaders/script/*.glsl that a pass calls
    float (*reference)(std::span<const float> arguments) = nullptr; // pure calls: their meaning, for the interpreter
    std::int32_t (*reference_integer)(std::span<const std::int32_t> arguments) =
        nullptr; // where integers stay integers
};

std::span<const Builtin> list_builtins();
const Builtin* find_builtin(std::string_view name); // aliases too; null if there is none

} // namespace photonloupe::script
