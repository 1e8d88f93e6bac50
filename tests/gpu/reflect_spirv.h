// SPDX-License-Identifier: Apache-2.0
// The struct layouts that compiled SPIR-V really uses, read back with SPIRV-Cross.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace photonloupe::test {

struct ReflectedMember {
    std::string name;
    std::uint32_t offset = 0;
    std::uint32_t size_bytes = 0;
};

struct ReflectedStruct {
    std::vector<ReflectedMember> members;
    std::uint32_t array_stride = 0; // where it is the element of a buffer; 0 elsewhere
};

// What one kernel exchanges with the host: each struct by its name in GLSL.
struct Reflection {
    std::map<std::string, ReflectedStruct> structs;
    std::vector<ReflectedMember> push_constants; // scalars that stand in the block itself
    std::uint32_t push_bytes = 0;
};

Reflection reflect_spirv(const std::vector<std::uint32_t>& words);

} // namespace photonloupe::test
