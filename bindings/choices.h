// SPDX-License-Identifier: Apache-2.0
// Names that Python gives for what the engine enumerates: one that is unknown is refused with those there are.
#pragma once

#include <string>

#include "pipeline.h"

namespace photonloupe::bindings {

// Each throws Error where the name is none of its choices.
DensityKernel parse_kernel(const std::string& name);
RenderMode parse_mode(const std::string& name);
Emission parse_emission(const std::string& name);
Store parse_store(const std::string& name);
Descriptor parse_descriptor(const std::string& name);
Space parse_space(const std::string& name);
RadiusSearch parse_search(const std::string& name);
SearchSpace parse_search_space(const std::string& name);

} // namespace photonloupe::bindings
