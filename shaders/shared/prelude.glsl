// SPDX-License-Identifier: Apache-2.0
// First include of every kernel: exact arithmetic, subgroups, and the workgroup size as specialisation constant 0.
#extension GL_EXT_spirv_intrinsics : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require

// SignedZeroInfNanPreserve: without it x - x folds to 0 and compensated sums vanish.
spirv_execution_mode(extensions = ["SPV_KHR_float_controls"], capabilities = [4466], 4461, 32);

layout(local_size_x_id = 0) in;

const float PI = 3.14159265358979323846;
#define INFINITY uintBitsToFloat(0x7f800000u)
#include "shared/subgroup.glsl"
