// SPDX-License-Identifier: Apache-2.0
// The GLSL of some scripts, word for word. PHOTONLOUPE_WRITE_GOLDENS=1 writes it anew; the commit says why it changed.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "gpu/compile_glsl.h"
#include "gpu/kernel_source.h"
#include "script/compile_script.h"

namespace photonloupe::script {
namespace {

const std::filesystem::path FOLDER = PHOTONLOUPE_SOURCE_DIR "/tests/script/golden";

std::string read_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::filesystem::path> list_scripts() {
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(FOLDER))
        if (entry.path().extension() == ".photon")
            paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    return paths;
}

void expect_compiles(const EmittedPass& pass) {
    const gpu::ExpandedSource expanded = gpu::expand_source({"script", 64, {}, {}, pass.glsl});
    for (const std::uint64_t by_address : {std::uint64_t{0}, (std::uint64_t{1} << expanded.bindings.size()) - 1})
        EXPECT_NO_THROW(gpu::compile_glsl(gpu::declare_bindings(expanded, {}, by_address), "script"));
}

TEST(Golden, passes_are_what_they_were) {
    for (const std::filesystem::path& path : list_scripts()) {
        const auto script = compile_script({path.filename().string(), read_file(path)});
        ASSERT_FALSE(script->has_errors) << format_diagnostics(script->program.source, script->diagnostics);
        std::string text;
        for (std::size_t i = 0; i < script->passes.size(); ++i) {
            ASSERT_TRUE(script->plan.loops[i].is_parallel) << path;
            text += script->passes[i].glsl;
            expect_compiles(script->passes[i]);
        }
        const std::filesystem::path golden = std::filesystem::path(path).replace_extension(".glsl");
        if (std::getenv("PHOTONLOUPE_WRITE_GOLDENS"))
            std::ofstream(golden, std::ios::binary) << text;
        EXPECT_EQ(text, read_file(golden)) << golden;
    }
}

} // namespace
} // namespace photonloupe::script
