// SPDX-License-Identifier: Apache-2.0
// Writes a photon's constraint: v_b across the structure with the share of movement w_v that it forbids, u_b along it.
// Outputs: constraint_along (u_b, w_u), constraint_across (v_b, w_v).
#pragma binding writeonly vec4 constraint_along
#pragma binding writeonly vec4 constraint_across

// With fewer neighbours nothing is known: the photon stays where it is.
const float FEWEST_MEMBERS = 12.0;

// 0 at `free_at`, 1 at `fixed_at`, whichever is larger.
float ramp(float value, float free_at, float fixed_at) {
    return clamp((value - free_at) / (fixed_at - free_at), 0.0, 1.0);
}

// `across` need not be a unit vector; it is turned to point up the gradient.
void write_constraint(uint position, float members, vec2 mean, vec2 across, float weight) {
    bool is_frozen = members < FEWEST_MEMBERS;
    if (is_frozen) across = mean;
    float size = max(abs(across.x), abs(across.y));
    vec2 direction = size > 0.0 ? normalize(across / size) : vec2(1.0, 0.0);
    if (dot(direction, mean) < 0.0) direction = -direction;
    vec3 v = lift_tangent(direction);
    constraint_along[position] = vec4(cross(v, my_normal), is_frozen ? 1.0 : 0.0);
    constraint_across[position] = vec4(v, is_frozen ? 1.0 : weight);
}
