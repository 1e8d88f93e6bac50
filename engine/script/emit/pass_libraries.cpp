// SPDX-License-Identifier: Apache-2.0
// The table of optional includes.
#include "script/emit/pass_libraries.h"

namespace photonloupe::script {
namespace {

constexpr PassLibrary LIBRARIES[] = {
    {"positions", "position_emitter"},
    {"normals", "normal_index"},
    {"powers", "power_object"},
    {"axes", ""},
    {"paths", "path_starts"},
    {"path_vertices", "path_vertices"},
    {"path_normals", "path_normals"},
    {"parameters", "parameter_columns"},
    {"colors", "colors"},
    {"lanes", "lane_words"},
    {"pca", ""},
    {"pca_words", ""},
    {"pca_lanes", ""},
    {"neighbors", "neighbor_rows"},
    {"histograms", "histogram_words"},
    {"prints", "print_bits"},
};

} // namespace

std::span<const PassLibrary> list_pass_libraries() {
    return LIBRARIES;
}

} // namespace photonloupe::script
