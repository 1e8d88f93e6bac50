// SPDX-License-Identifier: Apache-2.0
// Irradiance at a point from its k nearest photons on the same surface (METHODS §2), by one subgroup.
// A photon counts within radius r when n_i·n > 0.7, d_i ≤ r and |n·(x_i - x)| ≤ flatness·r: its measure is the
// smallest such r, squared. Define KERNEL. Inputs: tree_normals (tree order), power_object (by photon id).
#include "estimate/density.glsl"
#include "photons/same_surface.glsl"
#include "photons/select_nearest.glsl"
#pragma binding texel tree_normals
#pragma binding readonly vec4 power_object

vec3 gather_point;
vec3 gather_normal;
float gather_flatness;

bool measure_photon(uint position, vec4 photon, out float measure) {
    measure = measure_on_surface(photon.xyz - gather_point, gather_normal, tree_normals_at(position).xyz,
                                 gather_flatness);
    return measure < INFINITY;
}

// rgb; w: the same for photons that carry 1.
vec4 estimate_irradiance(uint photon_count, uint leaf_level, uint k) {
    float bound;
#if KERNEL == 1 // disc: r is the distance to the k-th itself, and (k - 1)/(π r²) is unbiased
    uint wanted = k;
#else
    uint wanted = k + 1u;
#endif
    uint count = find_smallest(gather_point, photon_count, leaf_level, wanted, bound);
    if (count == 0u) return vec4(0.0);
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
    float r = max(sqrt(r2), find_spacing(gather_point));
    r2 = r * r;
    vec4 sum = vec4(0.0);
    for (uint i = LANE; i < used; i += WIDTH) {
        vec4 photon = tree_positions_at(list[i].y);
        vec3 d = photon.xyz - gather_point;
        vec4 flux = vec4(power_object[floatBitsToUint(photon.w)].rgb, 1.0);
        sum += flux * weigh_photon(min(dot(d, d) / r2, 1.0));
    }
    vec4 total = vec4(subgroupAdd(sum.x), subgroupAdd(sum.y), subgroupAdd(sum.z), subgroupAdd(sum.w));
#if KERNEL == 1
    total *= float(count - 1u) / float(count);
#endif
    return spread_flux(total, r);
}
