// SPDX-License-Identifier: Apache-2.0
// GLSL to SPIR-V through glslang, with the words cached on disk by the hash of the text.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace photonloupe::gpu {

// Compiles one compute shader. `name` appears in messages. Throws Error with glslang's own text: kernels are ours,
// so a message here is our mistake.
std::vector<std::uint32_t> compile_glsl(const std::string& text, const std::string& name);

} // namespace photonloupe::gpu
