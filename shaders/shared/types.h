// SPDX-License-Identifier: Apache-2.0
// Lets one text be C++ and GLSL: the vector types' names, and a namespace on the C++ side.
// Shared structs hold only vec4, uvec4, float and uint, 16-byte rows, so that std430 and C++ agree.
#ifndef PHOTONLOUPE_SHARED_TYPES_H
#define PHOTONLOUPE_SHARED_TYPES_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#define SHARED_BEGIN namespace photonloupe::shared {
#define SHARED_END }
#define SHARED_INLINE inline
namespace photonloupe::shared {
using uint = std::uint32_t;
using glm::uvec2;
using glm::uvec4;
using glm::vec4;
} // namespace photonloupe::shared
#else
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_INLINE
#endif

#endif
