// SPDX-License-Identifier: Apache-2.0
// The fuzzer's seeds load, and damaged ones load or are refused.
#include "scene/gltf_builder.h"

#include <fstream>
#include <iterator>
#include <random>

#include <gtest/gtest.h>

namespace photonloupe::test {
namespace {

constexpr int DAMAGES_PER_SEED = 500;

std::vector<std::filesystem::path> list_seeds() {
    std::vector<std::filesystem::path> paths;
    const std::filesystem::path folder = std::filesystem::path(PHOTONLOUPE_SOURCE_DIR) / "tests/fuzz/corpus/scene";
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    return paths;
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(scene_corpus, every_seed_loads) {
    EXPECT_GE(list_seeds().size(), 8u);
    for (const std::filesystem::path& path : list_seeds())
        EXPECT_FALSE(load_text(read_text(path)).triangles.empty()) << path;
}

TEST(scene_corpus, damaged_seeds_load_or_are_refused) {
    std::mt19937 random(1);
    for (const std::filesystem::path& path : list_seeds())
        for (int i = 0; i < DAMAGES_PER_SEED; ++i) {
            std::string text = read_text(path);
            for (unsigned damage = 0; damage < 1 + random() % 4; ++damage)
                text[random() % text.size()] = char(random());
            find_text_refusal(text); // anything but SceneError ends the test
        }
}

} // namespace
} // namespace photonloupe::test
