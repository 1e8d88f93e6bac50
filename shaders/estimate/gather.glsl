// SPDX-License-Identifier: Apache-2.0
// Irradiance at a point from its k nearest photons on the same surface (METHODS §2), by one subgroup.
// A photon counts within radius r when n_i·n > 0.7, d_i ≤ r and |n·(x_i - x)| ≤ flatness·r: its measure is the
// smallest such r, squared. Define KERNEL. Inputs: tree_normals (tree order), power_object (by photon id).
#include "shared/math.glsl"
#include "photons/nearest.glsl"
#pragma binding texel tree_normals
#pragma binding readonly vec4 power_object

// Photons whose normal differs more belong to another surface (METHODS §2).
const float SAME_SURFACE_COSINE = 0.7;
// r for a set that takes every photon: a little beyond the farthest, so that its weight is not lost to rounding.
const float BEYOND_FARTHEST = 1.000001;
const float FLOAT_EPSILON = 1.1920929e-7;
const float SMALLEST_RADIUS = 1e-15; // its square is still a normal float

vec3 gather_point;
vec3 gather_normal;
float gather_flatness;

bool measure_photon(uint position, vec4 photon, out float measure) {
    precise vec3 d = photon.xyz - gather_point;
    precise float squared = d.x * d.x + d.y * d.y + d.z * d.z;
    float height = gather_flatness > 0.0 ? dot(gather_normal, d) / gather_flatness : 0.0;
    measure = max(squared, height * height);
    return dot(tree_normals_at(position).xyz, gather_normal) > SAME_SURFACE_COSINE;
}

// Weight of a photon at squared distance s = d²/r², times π r².
float weigh_photon(float s) {
#if KERNEL == 0 // KERNEL_EPANECHNIKOV
    return 2.0 * max(0.0, 1.0 - s);
#elif KERNEL == 1 // KERNEL_DISC; (k - 1)/k of it in estimate_irradiance
    return 1.0;
#elif KERNEL == 2 // KERNEL_CONE: 1 - d/(c r), normalized by 1 - 2/(3c), c = 1.1 (Jensen)
    return (1.0 - sqrt(s) / 1.1) / (1.0 - 2.0 / 3.3);
#else // KERNEL_GAUSSIAN: Jensen's 0.918 (1 - (1 - e^(-β s/2))/(1 - e^-β)), β = 1.953, normalized by 0.531
    return 0.918 * (1.0 - (1.0 - exp_exact(-1.953 * 0.5 * s)) / (1.0 - exp_exact(-1.953))) / 0.531;
#endif
}

vec3 estimate_irradiance(uint photon_count, uint leaf_level, uint k) {
    float bound;
#if KERNEL == 1 // disc: r is the distance to the k-th itself, and (k - 1)/(π r²) is unbiased
    uint wanted = k;
#else
    uint wanted = k + 1u;
#endif
    uint count = find_smallest(gather_point, photon_count, leaf_level, wanted, bound);
    if (count == 0u) return vec3(0.0);
    uint used = count;
    float r2;
    if (count < wanted || KERNEL == 1) {
        uint farthest = 0u;
        for (uint i = LANE; i < count; i += WIDTH) farthest = max(farthest, list[i].x);
        r2 = uintBitsToFloat(subgroupMax(farthest));
        if (KERNEL != 1) r2 *= BEYOND_FARTHEST * BEYOND_FARTHEST;
    } else {
        cut_list(count, k); // the (k + 1)-th gives r and is not itself counted
        r2 = uintBitsToFloat(list[k].x);
        used = k;
    }
    // Photons that coincide with the point are spread over the spacing of floats there: closer is not resolved.
    float spacing = max(max(abs(gather_point.x), max(abs(gather_point.y), abs(gather_point.z))) * FLOAT_EPSILON, SMALLEST_RADIUS);
    r2 = max(r2, spacing * spacing);
    vec3 sum = vec3(0.0);
    for (uint i = LANE; i < used; i += WIDTH) {
        vec4 photon = tree_positions_at(list[i].y);
        vec3 d = photon.xyz - gather_point;
        sum += power_object[floatBitsToUint(photon.w)].rgb * weigh_photon(min(dot(d, d) / r2, 1.0));
    }
    vec3 total = vec3(subgroupAdd(sum.x), subgroupAdd(sum.y), subgroupAdd(sum.z));
#if KERNEL == 1
    total *= float(count - 1u) / float(count);
#endif
    // In two steps: π r² of a tiny radius would underflow.
    float r = sqrt(r2);
    return total / r / (PI * r);
}
