// SPDX-License-Identifier: Apache-2.0
// Reads and writes the driver's pipeline cache; a missing or foreign file only means compiling again.
#include "gpu/driver_cache.h"

#include <fstream>
#include <iterator>

#include "core/atomic_file.h"
#include "core/cache_folder.h"
#include "core/error.h"

namespace photonloupe::gpu {
namespace {

std::filesystem::path find_cache_file(const Device::Impl& impl) {
    const std::filesystem::path folder = find_cache_folder();
    if (folder.empty())
        return {};
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(impl.physical, &properties);
    std::string name = "pipelines-";
    for (std::uint8_t byte : properties.pipelineCacheUUID) {
        constexpr char DIGITS[] = "0123456789abcdef";
        name += DIGITS[byte >> 4];
        name += DIGITS[byte & 15];
    }
    return folder / (name + ".bin");
}

} // namespace

VkPipelineCache load_pipeline_cache(const Device::Impl& impl) {
    std::vector<char> bytes;
    if (const std::filesystem::path path = find_cache_file(impl); !path.empty()) {
        std::ifstream file(path, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(file), {});
    }
    VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    info.initialDataSize = bytes.size(); // the driver checks the header and ignores what is not its own
    info.pInitialData = bytes.data();
    VkPipelineCache cache = VK_NULL_HANDLE;
    check(impl.table.vkCreatePipelineCache(impl.device, &info, nullptr, &cache), "vkCreatePipelineCache");
    return cache;
}

void save_pipeline_cache(const Device::Impl& impl) {
    const std::filesystem::path path = find_cache_file(impl);
    std::size_t size = 0;
    if (path.empty() ||
        impl.table.vkGetPipelineCacheData(impl.device, impl.pipeline_cache, &size, nullptr) != VK_SUCCESS)
        return;
    // Drivers without a real cache return the bare header.
    if (size <= sizeof(VkPipelineCacheHeaderVersionOne))
        return;
    std::vector<unsigned char> bytes(size);
    if (impl.table.vkGetPipelineCacheData(impl.device, impl.pipeline_cache, &size, bytes.data()) != VK_SUCCESS)
        return;
    try {
        write_file_atomically(path, {bytes.data(), size});
    } catch (const Error&) {
        // A full or read-only disk costs the next run its compile time and nothing else.
    }
}

} // namespace photonloupe::gpu
