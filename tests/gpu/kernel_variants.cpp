// SPDX-License-Identifier: Apache-2.0
// The kernels' structural defines as a table: each factor contributes one of its alternatives.
#include "gpu/kernel_variants.h"

#include <algorithm>
#include <filesystem>
#include <map>

namespace photonloupe::test {
namespace {

// Alternatives of which one is chosen; "" stands for no define.
using Factors = std::vector<std::vector<std::string>>;

const std::vector<std::string> STORES{"STORE_MODE 0", "STORE_MODE 1", "STORE_MODE 2"};
const std::vector<std::string> EMISSIONS{"EMISSION 0", "EMISSION 1"};
const std::vector<std::string> PATHS{"", "RECORD_PATHS"};
const std::vector<std::string> MIRROR{"", "HAS_MIRROR"};
const std::vector<std::string> DIELECTRIC{"", "HAS_DIELECTRIC"};
const std::vector<std::string> ABSORPTION{"", "HAS_ABSORPTION", "HAS_MEDIA"};
const std::vector<std::string> MEDIA{"", "HAS_MEDIA"};
const std::vector<std::string> PAINT{"", "HAS_TEXTURES", "HAS_VERTEX_COLORS",
                                     "HAS_TEXTURES\n#define HAS_VERTEX_COLORS\n#define HAS_ALPHA"},
    MATTER{"", "HAS_ROUGH",
           "HAS_ROUGH\n#define HAS_TEXTURES\n#define HAS_VERTEX_COLORS\n#define HAS_ALPHA\n#define HAS_TRANSLUCENCY\n"
           "#define HAS_LAYERS\n#define HAS_DISPERSION"};
const std::vector<std::string> SPOT{"", "HAS_SPOT_LIGHTS"}, DIRECTIONAL{"", "HAS_DIRECTIONAL_LIGHTS"},
    AREA{"", "HAS_AREA_LIGHTS"}, ENVIRONMENT{"", "HAS_ENVIRONMENT", "HAS_ENVIRONMENT\n#define HAS_ENVIRONMENT_MAP"},
    COLORED{"", "HAS_COLORED_EMISSION"};
const std::vector<std::string> OTHER_LIGHTS{"", "HAS_SPOT_LIGHTS\n#define HAS_DIRECTIONAL_LIGHTS\n#define "
                                                "HAS_AREA_LIGHTS\n#define HAS_ENVIRONMENT\n#define "
                                                "HAS_ENVIRONMENT_MAP\n#define HAS_COLORED_LAMPS\n#define "
                                                "HAS_COLORED_EMISSION\n#define HAS_SEVERAL_LIGHTS"};
const std::vector<std::string> KERNELS{"KERNEL 0", "KERNEL 1", "KERNEL 2", "KERNEL 3"};

const std::vector<std::string> SURFACE{"HAS_NORMALS", "HAS_NORMALS\n#define FLAT_AXES xz",
                                       "HAS_NORMALS\n#define ON_SURFACE"},
    PERIODIC{"", "PERIODIC"}, SINGLY{"", "SINGLY"};
// Two vec4s a row.
const std::string ROWS = "ROW_COUNT 2u\n#define EACH_ROW(DO) DO(0) DO(1)\n"
                         "#define EACH_PARAMETER(DO) DO(1) DO(2) DO(3) DO(4) DO(5)";
const std::vector<std::string> LAYERS{"", ROWS + "\n#define SAME_LAYER",
                                      ROWS + "\n#define SAME_LAYER\n#define PERIODIC_PARAMETERS"};
const std::vector<std::string> SPACES{"",
                                      "FLAT_AXES xz",
                                      SURFACE[2],
                                      ROWS + "\n#define SAME_LAYER",
                                      ROWS + "\n#define IN_INTERVALS",
                                      ROWS + "\n#define IN_PARAMETER_SPACE",
                                      ROWS + "\n#define IN_PARAMETER_SPACE\n#define PERIODIC_PARAMETERS"};
const std::vector<std::string> PARAMETERS{SPACES[5], SPACES[6]};
const std::vector<std::string> OWN{"", "OWN_PHOTONS"};
const std::vector<std::string> TIES{"", "CUT_TIES\n#define BY_ID", "CUT_TIES\n#define BY_ID\n#define WITHOUT_SELF"};
const std::vector<std::string> RUN{
    "RUN 2u\n#define EACH_OF_RUN(DO) DO(0u) DO(1u)\n#define EACH_PAIR_OF_RUN(DO) DO(0u)"},
    NETWORK{"SORT_NETWORK(DO) DO(0, 1)"}, RUNS{"RUNS 2\n#define EACH_RUN(DO) DO(0) DO(1)"};
const std::vector<std::string> SHELL{"SHELL_SIZE 2u\n#define EACH_KEPT(DO) DO(0) DO(1)"};
const std::vector<std::string> RANGES{"", "RANGE_ROWS 2u"};
const std::vector<std::string> SORT{"SORT_SIZE 32", "SORT_SIZE 64"};
const std::vector<std::string> DESCRIPTORS{"DESCRIPTOR 1", "DESCRIPTOR 2", "DESCRIPTOR 3"};

// Kernels that are not named here take no defines.
const std::map<std::string, Factors> FACTORS{
    {"estimate/accumulate_film.comp", {MEDIA}},
    {"estimate/estimate_irradiance.comp", {KERNELS, {SURFACE[2], "IN_SPACE"}, {"", "ONE_NORMAL"}, {TIES[1]}, SINGLY}},
    {"estimate/gather_beams.comp", {{"HAS_MEDIA"}}},
    {"estimate/light_beams.comp", {{"HAS_MEDIA"}, OTHER_LIGHTS, PAINT}},
    {"estimate/light_direct.comp", {SPOT, DIRECTIONAL, AREA, ENVIRONMENT, PAINT, MEDIA}},
    {"estimate/trace_eye.comp", {MIRROR, DIELECTRIC, ABSORPTION, MATTER, OTHER_LIGHTS}},
    {"estimate/plot_photons.comp", {PAINT, MEDIA}},
    {"inspect/see_surfaces.comp", {PAINT, MEDIA}},
    {"inspect/count_crossings.comp", {{"", "RAGGED"}}},
    {"photons/choose_brackets.comp", {RANGES}},
    {"photons/count_lefts.comp", {RANGES}},
    {"photons/find_pivots.comp", {RANGES}},
    {"photons/keep_between.comp", {RANGES}},
    {"photons/move_parts.comp", {RANGES}},
    {"photons/order_columns.comp", {RANGES}},
    {"photons/refit_leaves.comp", {RANGES}},
    {"photons/count_ties.comp", {SPACES, PERIODIC, {"SINGLY"}}},
    {"photons/find_radii.comp", {OWN, SPACES, PERIODIC, TIES, SHELL, {"", "CARRIED"}}},
    {"photons/list_neighbors.comp", {SPACES, {TIES[2]}, SINGLY}},
    {"photons/select_radius.comp", {SPACES, PERIODIC, {"BY_ID", TIES[1], TIES[2]}}},
    {"photons/sort_neighbors.comp", {RUN, NETWORK, {"", "IS_WHOLE"}}},
    {"photons/merge_neighbors.comp", {RUN, RUNS}},
    {"photons/refit_nodes.comp", {RANGES}},
    {"photons/scale_axes.comp", {{"RANGE_ROWS 2u"}, {"RANGE_AXES 7u"}, {"", "SPLIT_POSITIONS"}}},
    {"photons/split_nodes.comp", {RANGES}},
    {"photons/split_small_nodes.comp", {RANGES, SORT, {"EACH_KEY(DO) DO(0)"}, {"SORT_NETWORK(DO) DO(0, 1)"}}},
    {"relax/diffuse_flux.comp", {OWN, SURFACE, LAYERS, PERIODIC, SINGLY}},
    {"relax/measure_isotropy.comp", {OWN, PARAMETERS, SINGLY}},
    {"relax/measure_moments.comp", {DESCRIPTORS, SURFACE, LAYERS, PERIODIC, SINGLY}},
    {"relax/measure_split.comp", {SURFACE, LAYERS, PERIODIC, SINGLY}},
    {"relax/measure_tensor.comp", {SURFACE, LAYERS, PERIODIC, SINGLY}},
    {"relax/move_photons.comp", {{"", "HAS_SURFACE"}}},
    {"relax/repel_photons.comp", {SURFACE, LAYERS, PERIODIC, SINGLY, {"", "CARRIED"}, {"", "CONSTRAINED"}}},
    {"trace/shoot_photons.comp", {STORES, EMISSIONS, PATHS, MIRROR, DIELECTRIC, ABSORPTION, MATTER, OTHER_LIGHTS}},
    {"trace/sum_balance.comp", {COLORED}},
    {"trace/write_photons.comp", {PATHS}},
};

} // namespace

std::vector<std::string> list_kernels() {
    const std::filesystem::path root = PHOTONLOUPE_SOURCE_DIR "/shaders";
    std::vector<std::string> paths;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
        if (entry.path().extension() == ".comp")
            paths.push_back(std::filesystem::relative(entry.path(), root).string());
    std::sort(paths.begin(), paths.end());
    return paths;
}

std::vector<KernelVariant> list_variants() {
    std::vector<KernelVariant> variants;
    for (const std::string& path : list_kernels()) {
        std::vector<KernelVariant> of_this{{path, {}}};
        const auto factors = FACTORS.find(path);
        for (const std::vector<std::string>& choices : factors == FACTORS.end() ? Factors{} : factors->second) {
            std::vector<KernelVariant> longer;
            for (const KernelVariant& variant : of_this)
                for (const std::string& choice : choices) {
                    longer.push_back(variant);
                    if (!choice.empty())
                        longer.back().defines.push_back(choice);
                }
            of_this = std::move(longer);
        }
        variants.insert(variants.end(), of_this.begin(), of_this.end());
    }
    return variants;
}

} // namespace photonloupe::test
