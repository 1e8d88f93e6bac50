// SPDX-License-Identifier: Apache-2.0
// The tangent plane of the photon that gathers: coordinates of offsets in it, and directions back in space.
#include "shared/math.glsl"
#include "photons/candidates.glsl"

#ifdef FLAT_AXES
vec3 lift_place(Place p) {
    vec3 v = vec3(0.0);
    v.FLAT_AXES = p;
    return v;
}
void set_tangents() {}
vec2 project_offset(Place d) { return d; }
vec3 lift_tangent(vec2 t) { return lift_place(t); }
vec2 project_vector(vec3 v) { return v.FLAT_AXES; }
#else
#define lift_place(p) (p)
vec3 my_tangent;
vec3 my_bitangent;
void set_tangents() { build_basis(my_normal, my_tangent, my_bitangent); }
vec2 project_offset(Place d) { return vec2(dot(my_tangent, d), dot(my_bitangent, d)); }
vec3 lift_tangent(vec2 t) { return t.x * my_tangent + t.y * my_bitangent; }
vec2 project_vector(vec3 v) { return project_offset(v); }
#endif
