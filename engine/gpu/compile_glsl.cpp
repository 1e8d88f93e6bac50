// SPDX-License-Identifier: Apache-2.0
// Compiles kernels with glslang and keeps the SPIR-V in the user's cache.
#include "gpu/compile_glsl.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <glslang/build_info.h>

#include "core/atomic_file.h"
#include "core/cache_folder.h"
#include "core/error.h"
#include "core/hash.h"

namespace photonloupe::gpu {
namespace {

constexpr std::uint32_t SPIRV_MAGIC = 0x07230203u;

std::string hash_source(const std::string& text) {
    return hash_bytes(text + "\nglslang " + std::to_string(GLSLANG_VERSION_MAJOR) + "." +
                      std::to_string(GLSLANG_VERSION_MINOR) + "." + std::to_string(GLSLANG_VERSION_PATCH));
}

// A cached file is the words followed by their hash, so that a damaged one is compiled again.
std::vector<std::uint32_t> read_cached(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    if (bytes.size() <= HASH_TEXT_LENGTH || (bytes.size() - HASH_TEXT_LENGTH) % 4 != 0)
        return {};
    const std::string body = bytes.substr(0, bytes.size() - HASH_TEXT_LENGTH);
    if (hash_bytes(body) != bytes.substr(body.size()))
        return {};
    std::vector<std::uint32_t> words(body.size() / 4);
    std::memcpy(words.data(), body.data(), body.size());
    return words[0] == SPIRV_MAGIC ? words : std::vector<std::uint32_t>{};
}

void write_cached(const std::filesystem::path& path, const std::vector<std::uint32_t>& words) {
    const std::string body(reinterpret_cast<const char*>(words.data()), words.size() * 4);
    try {
        std::filesystem::create_directories(path.parent_path());
        const std::string content = body + hash_bytes(body);
        write_file_atomically(path, {reinterpret_cast<const unsigned char*>(content.data()), content.size()});
    } catch (const std::exception&) {
        // A full or read-only cache folder costs time, not results.
    }
}

std::vector<std::uint32_t> run_glslang(const std::string& text, const std::string& name) {
    static std::mutex mutex; // glslang keeps process-wide pools
    std::lock_guard lock(mutex);
    static const bool initialized = glslang::InitializeProcess();
    if (!initialized)
        throw Error("glslang could not be initialized");
    glslang::TShader shader(EShLangCompute);
    const char* strings = text.c_str();
    const char* names = name.c_str();
    shader.setStringsWithLengthsAndNames(&strings, nullptr, &names, 1);
    shader.setEnvInput(glslang::EShSourceGlsl, EShLangCompute, glslang::EShClientVulkan, 460);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_2);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_5);
    const EShMessages rules = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
    if (!shader.parse(GetDefaultResources(), 460, false, rules))
        throw Error("kernel " + name + " does not compile (a bug of photonloupe): " + shader.getInfoLog());
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(rules))
        throw Error("kernel " + name + " does not link (a bug of photonloupe): " + program.getInfoLog());
    std::vector<std::uint32_t> words;
    glslang::GlslangToSpv(*program.getIntermediate(EShLangCompute), words);
    return words;
}

} // namespace

std::vector<std::uint32_t> compile_glsl(const std::string& text, const std::string& name) {
    const std::filesystem::path folder = find_cache_folder();
    const std::filesystem::path path = folder.empty() ? folder : folder / "spirv" / (hash_source(text) + ".spv");
    if (!path.empty())
        if (std::vector<std::uint32_t> words = read_cached(path); !words.empty())
            return words;
    std::vector<std::uint32_t> words = run_glslang(text, name);
    if (!path.empty())
        write_cached(path, words);
    return words;
}

} // namespace photonloupe::gpu
