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

// Kernels that are not named here take no defines.
const std::map<std::string, Factors> FACTORS{
    {"estimate/estimate_irradiance.comp", {KERNELS, CAPACITY, BLOCK, NETWORK, LOAD, STORE}},
    {"estimate/select_irradiance.comp", {KERNELS}},
    {"estimate/trace_eye.comp", {MIRROR, DIELECTRIC, ABSORPTION}},
    {"photons/find_neighbors.comp", {CAPACITY, BLOCK, NETWORK, LOAD, STORE}},
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
