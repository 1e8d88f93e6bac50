// SPDX-License-Identifier: Apache-2.0
// Keeps the driver's compiled pipelines between runs (a stub on the software device, seconds saved on GPUs).
#pragma once

#include "gpu/device_impl.h"

namespace photonloupe::gpu {

VkPipelineCache load_pipeline_cache(const Device::Impl& impl);
void save_pipeline_cache(const Device::Impl& impl);

} // namespace photonloupe::gpu
