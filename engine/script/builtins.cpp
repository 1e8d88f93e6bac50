// SPDX-License-Identifier: Apache-2.0
// The table of predefined calls, in the order of the manual.
#include "script/builtins.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "script/reference_math.h"

namespace photonloupe::script {
namespace {

using Id = BuiltinId;
using Reals = std::span<const float>;
using Integers = std::span<const std::int32_t>;

constexpr std::span<const Argument> NONE;
constexpr Argument PHOTON_AXIS[] = {Argument::photon, Argument::axis};
constexpr Argument PHOTON_CHANNEL[] = {Argument::photon, Argument::channel};
constexpr Argument PHOTON[] = {Argument::photon};
constexpr Argument PHOTON_DIMENSION[] = {Argument::photon, Argument::dimension};
constexpr Argument PHOTON_VERTEX_AXIS[] = {Argument::photon, Argument::vertex, Argument::axis};
constexpr Argument PHOTON_VERTEX[] = {Argument::photon, Argument::vertex};
constexpr Argument QUERY[] = {Argument::photon, Argument::uniform_count};
constexpr Argument CONSTRAINED_QUERY[] = {Argument::photon, Argument::uniform_count, Argument::uniform_number};
constexpr Argument LIST[] = {Argument::list};
constexpr Argument DECLARATION[] = {Argument::dimension, Argument::uniform_number, Argument::uniform_number,
                                    Argument::text, Argument::flag};
constexpr Argument PHOTON_DIMENSION_NUMBER[] = {Argument::photon, Argument::dimension, Argument::number};
constexpr Argument PHOTON_NUMBER_3[] = {Argument::photon, Argument::number, Argument::number, Argument::number};
constexpr Argument NUMBER_CHANNEL[] = {Argument::number, Argument::channel};
constexpr Argument NUMBER_2[] = {Argument::number, Argument::number};
constexpr Argument NUMBER_3[] = {Argument::number, Argument::number, Argument::number};
constexpr Argument AXIS[] = {Argument::axis};
constexpr Argument AXIS_2[] = {Argument::axis, Argument::axis};
constexpr Argument HISTOGRAM[] = {Argument::text, Argument::number, Argument::uniform_number, Argument::uniform_number,
                                  Argument::bin_count};
constexpr Argument TEXT[] = {Argument::text};
constexpr Argument NUMBER[] = {Argument::number};
constexpr Argument ITEM_2[] = {Argument::item, Argument::item};
constexpr Argument NUMBER_6[] = {Argument::number, Argument::number, Argument::number,
                                 Argument::number, Argument::number, Argument::number};

constexpr std::uint32_t PATH = COLUMN_PATH_STARTS; // whatever reads a path needs to know where it starts

// `glsl` is script_ and the call's name in snake case: one function a call, overloaded where integers stay integers.
constexpr Builtin TABLE[] = {
    {"getNumPhotons", Id::get_num_photons, "getNumPhotons()", "photons", "The number of photons of the map.", NONE, 0,
     false, Result::integer, Effect::reads_photon, 0, "script_get_num_photons"},
    {"getPhotonPosition", Id::get_photon_position, "getPhotonPosition(photon, axis)", "photons",
     "Where the photon is stored: world coordinates in meters, y up.", PHOTON_AXIS, 2, false, Result::real,
     Effect::reads_photon, COLUMN_POSITION, "script_get_photon_position"},
    {"getPhotonNormal", Id::get_photon_normal, "getPhotonNormal(photon, axis)", "photons",
     "The unit normal of the surface it is stored on, towards the arriving light.", PHOTON_AXIS, 2, false, Result::real,
     Effect::reads_photon, COLUMN_NORMAL, "script_get_photon_normal"},
    {"getPhotonPower", Id::get_photon_power, "getPhotonPower(photon, channel)", "photons",
     "Its flux in watts: channel 0 red, 1 green, 2 blue.", PHOTON_CHANNEL, 2, false, Result::real, Effect::reads_photon,
     COLUMN_POWER, "script_get_photon_power"},
    {"getPhotonEmitter", Id::get_photon_emitter, "getPhotonEmitter(photon)", "photons",
     "The number of the light that sent it.", PHOTON, 1, false, Result::integer, Effect::reads_photon, COLUMN_EMITTER,
     "script_get_photon_emitter"},
    {"getPhotonParameter", Id::get_photon_parameter, "getPhotonParameter(photon, dimension)", "photons",
     "Its parameter; dimensions 0-2 are its position. NaN where it is unset.", PHOTON_DIMENSION, 2, false, Result::real,
     Effect::reads_photon, COLUMN_PARAMETERS, "script_get_photon_parameter"},
    {"getNumPathVertices", Id::get_num_path_vertices, "getNumPathVertices(photon)", "paths",
     "The number of vertices of its path, emitter and storage point included.", PHOTON, 1, false, Result::integer,
     Effect::reads_photon, COLUMN_PATH_STARTS, "script_get_num_path_vertices"},
    {"getPathVertex", Id::get_path_vertex, "getPathVertex(photon, vertex, axis)", "paths",
     "A vertex of its path in world coordinates; vertex 0 is on the emitter.", PHOTON_VERTEX_AXIS, 3, false,
     Result::real, Effect::reads_photon, PATH | COLUMN_PATH_VERTICES, "script_get_path_vertex"},
    {"getPathNormal", Id::get_path_normal, "getPathNormal(photon, vertex, axis)", "paths",
     "The unit normal at a vertex; vertex 0: the emitter's own, a point light's is the primal direction.",
     PHOTON_VERTEX_AXIS, 3, false, Result::real, Effect::reads_photon, PATH | COLUMN_PATH_NORMALS,
     "script_get_path_normal"},
    {"getPathInteraction", Id::get_path_interaction, "getPathInteraction(photon, vertex)", "paths",
     "1 where the path was reflected, 2 where it was transmitted, 3 where a medium scattered it, 0 at its end points.",
     PHOTON_VERTEX, 2, false, Result::integer, Effect::reads_photon, PATH | COLUMN_PATH_INTERACTIONS,
     "script_get_path_interaction"},
    {"getPathObject", Id::get_path_object, "getPathObject(photon, vertex)", "paths",
     "The number of the object met at a vertex.", PHOTON_VERTEX, 2, false, Result::integer, Effect::reads_photon,
     PATH | COLUMN_PATH_OBJECTS, "script_get_path_object"},
    {"getPathScatter", Id::other, "getPathScatter(photon, vertex)", "paths",
     "How the vertex scatters: 0 mirror-like, roughness for glossy, 1 diffuse.", PHOTON_VERTEX, 2, false, Result::real,
     Effect::reads_photon, PATH | COLUMN_PATH_SCATTER, "script_get_path_scatter"},
    {"getKNN", Id::get_knn, "getKNN(photon [, k])", "neighbors",
     "The k (1 to the most a query takes, else 50) nearest photons in the world, nearest first, ties by id, without "
     "the photon itself.",
     QUERY, 1, false, Result::list, Effect::queries, 0, "script_get_knn"},
    {"getParameterKNN", Id::get_parameter_knn, "getParameterKNN(photon [, k])", "neighbors",
     "The k (1 to the most a query takes, else 50) nearest photons in parameter space, nearest first, ties by id.",
     QUERY, 1, false, Result::list, Effect::queries, COLUMN_PARAMETERS, "script_get_parameter_knn"},
    {"getConstrainedKNN", Id::get_constrained_knn, "getConstrainedKNN(photon, k, beta)", "neighbors",
     "The k nearest photons in the world among those within beta times r_q in parameter space.", CONSTRAINED_QUERY, 3,
     false, Result::list, Effect::queries, COLUMN_PARAMETERS, "script_get_constrained_knn"},
    {"length", Id::length, "length(list)", "neighbors", "The number of photons in a neighbor list.", LIST, 1, false,
     Result::integer, Effect::none, 0, "script_length"},
    {"declarePhotonParameter", Id::declare_photon_parameter,
     "declarePhotonParameter(dimension, lo, hi [, \"name\" [, periodic]])", "parameters",
     "Gives all photons a parameter in dimension 3-15 with bounds lo < hi; periodic: hi meets lo.", DECLARATION, 3,
     false, Result::none, Effect::declares, 0, "script_declare_photon_parameter"},
    {"setPhotonParameter", Id::set_photon_parameter, "setPhotonParameter(photon, dimension, value)", "parameters",
     "Sets the photon's parameter; NaN and inf leave it unset.", PHOTON_DIMENSION_NUMBER, 3, false, Result::none,
     Effect::sets_photon, 0, "script_set_photon_parameter"},
    {"setPhotonColourEncoding", Id::set_photon_colour_encoding, "setPhotonColourEncoding(photon, r, g, b)", "color",
     "Sets the photon's color in pictures, each channel in [0, 1].", PHOTON_NUMBER_3, 4, false, Result::none,
     Effect::sets_photon, 0, "script_set_photon_colour_encoding"},
    {"hue", Id::other, "hue(angle, channel)", "color",
     "1/2 + 1/2 cos(angle - 2 pi channel / 3): a color wheel, channel 0 red, 1 green, 2 blue.", NUMBER_CHANNEL, 2,
     false, Result::real, Effect::none, 0, "script_hue", [](Reals a) { return compute_hue(a[0], a[1]); }},
    {"resetPCA2D", Id::reset_pca_2d, "resetPCA2D()", "PCA", "Forgets the points pushed so far (2-D).", NONE, 0, false,
     Result::none, Effect::changes_pca, 0, "script_reset_pca_2d"},
    {"pushPCA2D", Id::push_pca_2d, "pushPCA2D(u, v)", "PCA", "Adds a point to the 2-D principal component analysis.",
     NUMBER_2, 2, false, Result::none, Effect::changes_pca, 0, "script_push_pca_2d"},
    {"decomposePCA2D", Id::decompose_pca_2d, "decomposePCA2D()", "PCA",
     "Finds the principal components of the points pushed; 0 for fewer than two points, or all equal.", NONE, 0, false,
     Result::integer, Effect::decomposes_pca, 0, "script_decompose_pca_2d"},
    {"resetPCA3D", Id::reset_pca_3d, "resetPCA3D()", "PCA", "Forgets the points pushed so far (3-D).", NONE, 0, false,
     Result::none, Effect::changes_pca, 0, "script_reset_pca_3d"},
    {"pushPCA3D", Id::push_pca_3d, "pushPCA3D(x, y, z)", "PCA", "Adds a point to the 3-D principal component analysis.",
     NUMBER_3, 3, false, Result::none, Effect::changes_pca, 0, "script_push_pca_3d"},
    {"decomposePCA3D", Id::decompose_pca_3d, "decomposePCA3D()", "PCA",
     "Finds the principal components of the points pushed; 0 for fewer than two points, or all equal.", NONE, 0, false,
     Result::integer, Effect::decomposes_pca, 0, "script_decompose_pca_3d"},
    {"getPCAEigenvalue", Id::get_pca_eigenvalue, "getPCAEigenvalue(j)", "PCA",
     "The variance along component j; component 0 has the largest.", AXIS, 1, false, Result::real, Effect::reads_pca, 0,
     "script_get_pca_eigenvalue"},
    {"getPCAEigenvector", Id::get_pca_eigenvector, "getPCAEigenvector(j, axis)", "PCA",
     "A coordinate of the unit vector of component j; its dot product with the first point pushed is not negative.",
     AXIS_2, 2, false, Result::real, Effect::reads_pca, 0, "script_get_pca_eigenvector"},
    {"getPCAMean", Id::get_pca_mean, "getPCAMean(axis)", "PCA", "A coordinate of the mean of the points.", AXIS, 1,
     false, Result::real, Effect::reads_pca, 0, "script_get_pca_mean"},
    {"histogram", Id::histogram, "histogram(\"name\", value, lo, hi [, bins])", "reports",
     "Counts the value in one of the (1-4,096, else 64) equal bins from lo to hi, both included; values outside are "
     "counted apart.",
     HISTOGRAM, 4, false, Result::none, Effect::reports, 0, "script_histogram"},
    {"print", Id::print, "print(\"text\" [, value ...])", "reports",
     "Prints a line; in a photon loop the first 20 by photon id.", TEXT, 1, true, Result::none, Effect::reports, 0,
     "script_print"},
    {"abs", Id::other, "abs(x)", "math", "Without its sign.", NUMBER, 1, false, Result::as_arguments, Effect::none, 0,
     "script_abs", [](Reals a) { return std::fabs(a[0]); },
     [](Integers a) { return a[0] < 0 ? subtract_wrapping(0, a[0]) : a[0]; }},
    {"sign", Id::other, "sign(x)", "math", "-1, 0 or 1.", NUMBER, 1, false, Result::as_arguments, Effect::none, 0,
     "script_sign", [](Reals a) { return compute_sign(a[0]); }, [](Integers a) { return (a[0] > 0) - (a[0] < 0); }},
    {"int", Id::int_, "int(x)", "math",
     "x cut off towards zero, as an integer; what does not fit is reported and becomes the nearest integer, NaN 0.",
     NUMBER, 1, false, Result::integer, Effect::none, 0, "script_int", [](Reals a) { return std::trunc(a[0]); },
     [](Integers a) { return a[0]; }},
    {"floor", Id::floor, "floor(x)", "math",
     "The largest whole number not above x, as an integer; what does not fit is reported and becomes the "
     "nearest integer, NaN 0.",
     NUMBER, 1, false, Result::integer, Effect::none, 0, "script_floor", [](Reals a) { return std::floor(a[0]); },
     [](Integers a) { return a[0]; }},
    {"ceil", Id::ceil, "ceil(x)", "math",
     "The smallest whole number not below x, as an integer; what does not fit is reported and becomes the "
     "nearest integer, NaN 0.",
     NUMBER, 1, false, Result::integer, Effect::none, 0, "script_ceil", [](Reals a) { return std::ceil(a[0]); },
     [](Integers a) { return a[0]; }},
    {"round", Id::round, "round(x)", "math",
     "The nearest whole number, halves away from zero, as an integer; what does not fit is reported and "
     "becomes the nearest integer, NaN 0.",
     NUMBER, 1, false, Result::integer, Effect::none, 0, "script_round", [](Reals a) { return compute_round(a[0]); },
     [](Integers a) { return a[0]; }},
    {"fract", Id::other, "fract(x)", "math", "x - floor(x).", NUMBER, 1, false, Result::real, Effect::none, 0,
     "script_fract", [](Reals a) { return compute_fract(a[0]); }},
    {"mod", Id::mod, "mod(x, y)", "math", "x - y floor(x / y): has y's sign, unlike %. Of integers an integer.",
     NUMBER_2, 2, false, Result::as_arguments, Effect::none, 0, "script_mod",
     [](Reals a) { return compute_mod(a[0], a[1]); }, [](Integers a) { return compute_mod(a[0], a[1]); }},
    {"min", Id::min, "min(x, y)", "math", "The smaller; NaN if either is, -0 < +0.", NUMBER_2, 2, false,
     Result::as_arguments, Effect::none, 0, "script_min", [](Reals a) { return compute_minimum(a[0], a[1]); },
     [](Integers a) { return std::min(a[0], a[1]); }},
    {"max", Id::max, "max(x, y)", "math", "The larger; NaN if either is, -0 < +0.", NUMBER_2, 2, false,
     Result::as_arguments, Effect::none, 0, "script_max", [](Reals a) { return compute_maximum(a[0], a[1]); },
     [](Integers a) { return std::max(a[0], a[1]); }},
    {"clamp", Id::clamp, "clamp(x, lo, hi)", "math", "min(max(x, lo), hi).", NUMBER_3, 3, false, Result::as_arguments,
     Effect::none, 0, "script_clamp", [](Reals a) { return compute_clamp(a[0], a[1], a[2]); },
     [](Integers a) { return std::min(std::max(a[0], a[1]), a[2]); }},
    {"mix", Id::other, "mix(a, b, t)", "math", "a (1 - t) + b t.", NUMBER_3, 3, false, Result::real, Effect::none, 0,
     "script_mix", [](Reals a) { return compute_mix(a[0], a[1], a[2]); }},
    {"step", Id::other, "step(edge, x)", "math", "0 where x is below the edge, else 1.", NUMBER_2, 2, false,
     Result::real, Effect::none, 0, "script_step", [](Reals a) { return compute_step(a[0], a[1]); }},
    {"smoothstep", Id::other, "smoothstep(lo, hi, x)", "math", "0 below lo, 1 above hi, t t (3 - 2 t) between them.",
     NUMBER_3, 3, false, Result::real, Effect::none, 0, "script_smoothstep",
     [](Reals a) { return compute_smoothstep(a[0], a[1], a[2]); }},
    {"sqrt", Id::other, "sqrt(x)", "math", "The square root; NaN below 0.", NUMBER, 1, false, Result::real,
     Effect::none, 0, "script_sqrt", [](Reals a) { return std::sqrt(a[0]); }},
    {"pow", Id::pow, "pow(x, y)", "math",
     "x to the power y. An integer if x is one and y a whole number from 0 on written out; beyond 32 bits "
     "reported.",
     NUMBER_2, 2, false, Result::real, Effect::none, 0, "script_pow", [](Reals a) { return compute_power(a[0], a[1]); },
     [](Integers a) { return raise_integer(a[0], a[1]).value; }},
    {"exp", Id::other, "exp(x)", "math", "e to the power x.", NUMBER, 1, false, Result::real, Effect::none, 0,
     "script_exp", [](Reals a) { return float(std::exp(double(a[0]))); }},
    {"log", Id::other, "log(x)", "math", "The natural logarithm; NaN below 0.", NUMBER, 1, false, Result::real,
     Effect::none, 0, "script_log", [](Reals a) { return float(std::log(double(a[0]))); }},
    {"sin", Id::other, "sin(x)", "math", "The sine of x radians.", NUMBER, 1, false, Result::real, Effect::none, 0,
     "script_sin", [](Reals a) { return float(std::sin(double(a[0]))); }},
    {"cos", Id::other, "cos(x)", "math", "The cosine of x radians.", NUMBER, 1, false, Result::real, Effect::none, 0,
     "script_cos", [](Reals a) { return float(std::cos(double(a[0]))); }},
    {"tan", Id::other, "tan(x)", "math", "The tangent of x radians.", NUMBER, 1, false, Result::real, Effect::none, 0,
     "script_tan", [](Reals a) { return float(std::tan(double(a[0]))); }},
    {"asin", Id::other, "asin(x)", "math",
     "The arc sine in radians; x up to 1e-5 outside [-1, 1] is clamped, farther out it is NaN.", NUMBER, 1, false,
     Result::real, Effect::none, 0, "script_asin", [](Reals a) { return compute_arc_sine(a[0]); }},
    {"acos", Id::other, "acos(x)", "math",
     "The arc cosine in radians; x up to 1e-5 outside [-1, 1] is clamped, farther out it is NaN.", NUMBER, 1, false,
     Result::real, Effect::none, 0, "script_acos", [](Reals a) { return compute_arc_cosine(a[0]); }},
    {"atan", Id::other, "atan(x)", "math", "The arc tangent in radians.", NUMBER, 1, false, Result::real, Effect::none,
     0, "script_atan", [](Reals a) { return float(std::atan(double(a[0]))); }},
    {"atan2", Id::other, "atan2(y, x)", "math", "The angle of the point (x, y) in (-pi, pi].", NUMBER_2, 2, false,
     Result::real, Effect::none, 0, "script_atan2",
     [](Reals a) { return float(std::atan2(double(a[0]), double(a[1]))); }},
    {"random", Id::random, "random(i, salt)", "math",
     "Uniform in [0, 1): a function of the seed and of two whole numbers, such as a photon and which draw it is.",
     ITEM_2, 2, false, Result::real, Effect::none, 0, "script_random"},
    {"magnitude", Id::other, "magnitude(x, y [, z])", "math", "The length of a vector, without overflow on the way.",
     NUMBER_3, 2, false, Result::real, Effect::none, 0, "script_magnitude",
     [](Reals a) { return compute_magnitude(a); }},
    {"dot", Id::dot, "dot(x0, y0 [, z0], x1, y1 [, z1])", "math",
     "The dot product of two vectors of two or three numbers each.", NUMBER_6, 4, false, Result::real, Effect::none, 0,
     "script_dot", [](Reals a) { return compute_dot(a); }},
};

constexpr std::pair<std::string_view, std::string_view> ALIASES[] = {
    {"getNumVertices", "getNumPathVertices"},
    {"setPhotonColorEncoding", "setPhotonColourEncoding"},
};

} // namespace

std::span<const Builtin> list_builtins() {
    return TABLE;
}

const Builtin* find_builtin(std::string_view name) {
    for (const auto& [alias, meant] : ALIASES)
        if (alias == name)
            name = meant;
    const auto found =
        std::find_if(std::begin(TABLE), std::end(TABLE), [&](const Builtin& builtin) { return builtin.name == name; });
    return found == std::end(TABLE) ? nullptr : &*found;
}

} // namespace photonloupe::script
