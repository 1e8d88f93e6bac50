// SPDX-License-Identifier: Apache-2.0
// Copies parameters into tree order, with how far each photon's layer reaches. Inputs: tree_positions, by photon id
// parameter_values (PARAMETER_ROWS vec4s each) and parameter_radii2. Outputs: tree_parameters (NaN in all rows where
// one is unset), parameter_reach (squared β·r_q).
#include "shared/prelude.glsl"
#pragma binding readonly vec4 tree_positions
#pragma binding readonly vec4 parameter_values
#pragma binding readonly float parameter_radii2
#pragma binding writeonly vec4 tree_parameters
#pragma binding writeonly float parameter_reach

layout(push_constant) uniform Push { uint first; uint count; float beta; uint pad; };

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    uint position = first + gl_GlobalInvocationID.x;
    uint photon = floatBitsToUint(tree_positions[position].w);
    for (uint row = 0u; row < PARAMETER_ROWS; ++row)
        tree_parameters[PARAMETER_ROWS * position + row] = parameter_values[PARAMETER_ROWS * photon + row];
    float radius2 = parameter_radii2[photon];
    parameter_reach[position] = beta > 0.0 ? beta * beta * radius2 : 0.0;
}
