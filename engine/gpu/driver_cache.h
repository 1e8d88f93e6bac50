// SPDX-License-Identifier: Apache-2.0
// The software device's machine code between runs: Mesa compiles a kernel at its first dispatch and keeps the code in a
// folder of files. We keep marks beside them, as Mesa cannot be asked what it has.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "gpu/device_impl.h"

namespace photonloupe::gpu {

// Where Mesa keeps its files; empty when it keeps none.
std::filesystem::path find_driver_cache();

// Names the machine code of a kernel whose buffers all have descriptors.
std::string hash_machine_code(const Device::Impl& device, const KernelSource& source);

bool is_marked_compiled(const std::string& hash);
void mark_compiled(const std::string& hash);

// Bytes in the folder. Mesa writes from a thread of the lowest priority, after the dispatch has ended.
std::uintmax_t measure_driver_cache();

} // namespace photonloupe::gpu
