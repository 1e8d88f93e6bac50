// SPDX-License-Identifier: Apache-2.0
// The triangle each photon lies on before relaxation begins. Inputs: tree_positions, tree_normals, power_object,
// radii (squared: a photon farther from its object than a share of its radius lies on none), geometry.
// Outputs: photon_triangles (| BACK_SIDE; NO_TRIANGLE: none).
#include "shared/prelude.glsl"
#include "shared/math.glsl"
#include "shared/photons.h"
#include "shared/relax.h"
#include "scene/closest_point.glsl"
#pragma binding texel tree_positions
#pragma binding texel tree_normals
#pragma binding texel power_object
#pragma binding texel radii
#pragma binding writeonly uint photon_triangles

layout(push_constant) uniform Push { MoveSettings settings; };

// Traced photons are within rounding of their triangle; a user's own may be rougher.
const float SURFACE_SHARE = 0.1;
const float ROUNDING = 1e-5;

void main() {
    bool valid = gl_GlobalInvocationID.x < settings.count;
    uint position = settings.first + min(gl_GlobalInvocationID.x, settings.count - 1u);
    vec4 photon = tree_positions_at(position);
    vec3 normal = tree_normals_at(position).xyz;
    uint object = floatBitsToUint(power_object_at(floatBitsToUint(photon.w)).w);
    bool lies_on_one = valid && dot(normal, normal) > square(SURFACE_NORMAL_LENGTH); // none in a medium
    vec3 size = abs(photon.xyz);
    float reach = max(SURFACE_SHARE * sqrt(radii_at(position).x), ROUNDING * max(size.x, max(size.y, size.z)));
    Closest front = Closest(reach * reach, NO_TRIANGLE, photon.xyz, vec3(0.0), false);
    find_closest(lies_on_one, Sought(photon.xyz, normal, 0.0, object), front);
    Closest back = Closest(front.distance2, NO_TRIANGLE, photon.xyz, vec3(0.0), false);
    find_closest(lies_on_one, Sought(photon.xyz, -normal, 0.0, object), back);
    if (valid) photon_triangles[position] = back.triangle != NO_TRIANGLE ? back.triangle | BACK_SIDE : front.triangle;
}
