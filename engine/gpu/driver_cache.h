// SPDX-License-Identifier: Apache-2.0
// What drivers have compiled, between runs. Their pipelines: a stub on the software device, seconds saved on GPUs. The
// software device's machine code: Mesa compiles a kernel at its first dispatch and keeps the code in a folder of files.
// We keep marks beside them, as Mesa cannot be asked what it has.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "gpu/device_impl.h"

namespace photonloupe::gpu {

VkPipelineCache load_pipeline_cache(const Device::Impl& impl);
void save_pipeline_cache(const Device::Impl& impl);

// Where Mesa keeps its files; empty when it keeps none.
std::filesystem::path find_driver_cache();

// Names the machine code of a kernel whose buffers all have descriptors.
std::string hash_machine_code(const Device::Impl& device, const KernelSource& source);

bool is_marked_compiled(const std::string& hash);
void mark_compiled(const std::string& hash);

// Bytes in the folder. Mesa writes from a thread of the lowest priority, after the dispatch has ended.
std::uintmax_t measure_driver_cache();

} // namespace photonloupe::gpu
