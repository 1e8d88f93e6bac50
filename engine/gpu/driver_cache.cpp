// SPDX-License-Identifier: Apache-2.0
// Finds Mesa's cache folder and keeps a mark, an empty file, for each kernel whose machine code it holds.
#include "gpu/driver_cache.h"

#include <cstdlib>
#include <cstring>
#include <fstream>

#include "core/hash.h"

namespace photonloupe::gpu {
namespace {

constexpr const char* MARKS = "photonloupe-compiled";

bool is_true(const char* variable) {
    const char* value = std::getenv(variable);
    return value && (std::strcmp(value, "1") == 0 || std::strcmp(value, "true") == 0);
}

} // namespace

std::filesystem::path find_driver_cache() {
    const char* folder = std::getenv("MESA_SHADER_CACHE_DIR"); // the instance has set it, where we have a folder
    if (!folder || is_true("MESA_SHADER_CACHE_DISABLE"))
        return {};
    return folder;
}

std::string hash_machine_code(const Device::Impl& device, const KernelSource& source) {
    const std::uint32_t workgroup = source.workgroup_size ? source.workgroup_size : device.limits.subgroup_size;
    std::string text = declare_bindings(expand_source(source), source.defines, 0);
    for (const std::uint32_t constant : source.constants)
        text += '#' + std::to_string(constant);
    return hash_bytes(text + '|' + std::to_string(workgroup) + '|' + device.info.name + '|' + device.info.driver);
}

bool is_marked_compiled(const std::string& hash) {
    std::error_code error;
    return std::filesystem::exists(find_driver_cache() / MARKS / hash, error);
}

void mark_compiled(const std::string& hash) {
    const std::filesystem::path folder = find_driver_cache();
    if (folder.empty())
        return;
    std::error_code error; // without a mark the next run looks again, no more
    std::filesystem::create_directories(folder / MARKS, error);
    std::ofstream(folder / MARKS / hash).flush();
}

std::uintmax_t measure_driver_cache() {
    std::uintmax_t bytes = 0;
    std::error_code error;
    for (std::filesystem::recursive_directory_iterator file(find_driver_cache(), error), end; !error && file != end;
         file.increment(error))
        if (file->path().extension() != ".tmp" && file->is_regular_file(error)) {
            const std::uintmax_t size = file->file_size(error);
            bytes += error ? 0 : size; // one may have gone since it was listed
        }
    return bytes;
}

} // namespace photonloupe::gpu
