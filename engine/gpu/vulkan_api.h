// SPDX-License-Identifier: Apache-2.0
// The Vulkan entry points (opened at first use by volk) and the check of their results. Only engine/gpu includes this.
#pragma once

#include <string>

#include <volk.h>

namespace photonloupe::gpu {

// Throws DeviceError (MemoryError for exhausted memory) naming the call when `result` is an error.
void check(VkResult result, const char* call);

std::string describe_result(VkResult result);

} // namespace photonloupe::gpu
