// SPDX-License-Identifier: Apache-2.0
// Names that Python gives for what the engine enumerates: one that is unknown is refused with those there are.
#pragma once

#include <string>

#include "estimate/render_image.h"
#include "inspect/loupe.h"
#include "relax/settings.h"
#include "trace/trace_photons.h"

namespace photonloupe::bindings {

// Each throws Error where the name is none of its choices.
DensityKernel parse_kernel(const std::string& name);
RenderMode parse_mode(const std::string& name);
Emission parse_emission(const std::string& name);
Store parse_store(const std::string& name);
Descriptor parse_descriptor(const std::string& name);
Space parse_space(const std::string& name);
RadiusSearch parse_search(const std::string& name);
inspect::LoupeSpace parse_loupe_space(const std::string& name); // also of neighbors

} // namespace photonloupe::bindings
