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
const std::vector<std::string> ABSORPTION{"", "HAS_ABSORPTION"};
const std::vector<std::string> LIGHTS{"", "HAS_SEVERAL_LIGHTS"};
const std::vector<std::string> CAPACITY{"CAPACITY 128u", "CAPACITY 256u"};
// Three of these are code that engine/photons/query_tree.cpp writes; nothing stands for them here.
const std::vector<std::string> BLOCK{"SORT_BLOCK 128u"}, NETWORK{"SORT_NETWORK"}, LOAD{"LOAD_KEYS"},
    STORE{"STORE_KEYS"};
const std::vector<std::string> KERNELS{"KERNEL 0", "KERNEL 1", "KERNEL 2", "KERNEL 3"};

const std::vector<std::string> SPACES{"SPACE 0", "SPACE 1", "SPACE 2"};
const std::vector<std::string> FLAT{"", "FLAT_AXES xz"}, PERIODIC{"", "PERIODIC"}, SINGLY{"", "SINGLY"};
// Two rows of parameters; kernels in parameter space always have some.
const std::vector<std::string> SOME_PARAMETERS{"PARAMETER_COUNT 5u\n#define PARAMETER_ROWS 2u\n"
                                               "#define EACH_PARAMETER(DO) DO(0) DO(1) DO(2) DO(3) DO(4)"};
const std::vector<std::string> PARAMETERS{"", SOME_PARAMETERS[0] + "\n#define TREE_RANGES uint[3](0u, 4u, 255u)",
                                          SOME_PARAMETERS[0] + "\n#define PERIODIC_PARAMETERS"};
const std::vector<std::string> SHELL{"SHELL_SIZE 2u\n#define EACH_KEPT(DO) DO(0) DO(1)"};
const std::vector<std::string> RANGES{"", "RANGE_ROWS 2u"};
const std::vector<std::string> SORT{"SORT_SIZE 32", "SORT_SIZE 64", "SORT_SIZE 128"};
const std::vector<std::string> DESCRIPTORS{"DESCRIPTOR 1", "DESCRIPTOR 2", "DESCRIPTOR 3"};

// Kernels that are not named here take no defines.
const std::map<std::string, Factors> FACTORS{
    {"estimate/estimate_irradiance.comp", {KERNELS, CAPACITY, BLOCK, NETWORK, LOAD, STORE}},
    {"estimate/select_irradiance.comp", {KERNELS}},
    {"estimate/trace_eye.comp", {MIRROR, DIELECTRIC, ABSORPTION}},
    {"inspect/count_crossings.comp", {{"", "RAGGED"}}},
    {"photons/choose_brackets.comp", {RANGES}},
    {"photons/count_lefts.comp", {RANGES}},
    {"photons/find_neighbors.comp", {CAPACITY, BLOCK, NETWORK, LOAD, STORE, SPACES, SOME_PARAMETERS}},
    {"photons/find_parameter_radius.comp", {SHELL, SOME_PARAMETERS, PERIODIC, SINGLY}},
    {"photons/find_pivots.comp", {RANGES}},
    {"photons/gather_parameters.comp", {{"PARAMETER_ROWS 2u"}}},
    {"photons/keep_between.comp", {RANGES}},
    {"photons/move_parts.comp", {RANGES}},
    {"photons/order_columns.comp", {RANGES}},
    {"photons/refit_leaves.comp", {RANGES}},
    {"photons/refit_nodes.comp", {RANGES}},
    {"photons/scale_axes.comp", {{"RANGE_ROWS 2u"}, {"RANGE_AXES 7u"}, {"", "SPLIT_POSITIONS"}}},
    {"photons/select_neighbors.comp", {SPACES, SOME_PARAMETERS}},
    {"photons/split_nodes.comp", {RANGES}},
    {"photons/split_small_nodes.comp", {RANGES, SORT, {"EACH_KEY(DO) DO(0)"}, {"SORT_NETWORK(DO) DO(0, 1)"}}},
    {"relax/diffuse_flux.comp", {FLAT, PARAMETERS, PERIODIC, SINGLY}},
    {"relax/measure_isotropy.comp", {SHELL, SOME_PARAMETERS, PERIODIC, SINGLY}},
    {"relax/measure_moments.comp", {SHELL, DESCRIPTORS, FLAT, PARAMETERS, PERIODIC, SINGLY}},
    {"relax/measure_split.comp", {FLAT, PARAMETERS, PERIODIC}},
    {"relax/measure_tensor.comp", {FLAT, PARAMETERS, PERIODIC, SINGLY}},
    {"relax/move_photons.comp", {{"", "HAS_SURFACE"}}},
    {"relax/repel_photons.comp", {SHELL, FLAT, PARAMETERS, PERIODIC, SINGLY, {"", "CARRIED"}, {"", "CONSTRAINED"}}},
    {"trace/shoot_photons.comp", {STORES, EMISSIONS, PATHS, MIRROR, DIELECTRIC, ABSORPTION, LIGHTS}},
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
