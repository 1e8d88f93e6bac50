// SPDX-License-Identifier: Apache-2.0
// Which photons lie on the same surface as a point, and how far they count as being (METHODS §2); bounds of both over
// boxes of photons and of queries.

// Photons whose normal differs more belong to another surface.
const float SAME_SURFACE_COSINE = 0.7;
// What rounding may do to a sum of three products, as a share of the largest.
const float PRODUCT_ROUNDING = 1e-6;

// Square of the smallest radius r whose ball takes in a photon at offset `d`: |d| ≤ r and |n·d| ≤ flatness·r.
// INFINITY on another surface; no test of the height when flatness is 0.
float measure_on_surface(vec3 d, vec3 normal, vec3 other_normal, float flatness) {
    precise float squared = d.x * d.x + d.y * d.y + d.z * d.z;
    float height = flatness > 0.0 ? dot(normal, d) / flatness : 0.0;
    return dot(other_normal, normal) > SAME_SURFACE_COSINE ? max(squared, height * height) : INFINITY;
}

// The measure is at most this for photons at that squared distance.
float limit_measure(float distance2, float flatness) {
    return flatness > 0.0 ? distance2 / min(1.0, flatness * flatness) : distance2;
}

// Products of two intervals, an axis at a time.
vec3 find_least_products(vec3 a_lo, vec3 a_hi, vec3 b_lo, vec3 b_hi) {
    return min(min(a_lo * b_lo, a_lo * b_hi), min(a_hi * b_lo, a_hi * b_hi));
}

vec3 find_most_products(vec3 a_lo, vec3 a_hi, vec3 b_lo, vec3 b_hi) {
    return max(max(a_lo * b_lo, a_lo * b_hi), max(a_hi * b_lo, a_hi * b_hi));
}

// Whether a normal within one box may be of the same surface as one within the other.
bool may_share_surface(vec3 lo, vec3 hi, vec3 other_lo, vec3 other_hi) {
    vec3 most = find_most_products(lo, hi, other_lo, other_hi);
    return most.x + most.y + most.z > SAME_SURFACE_COSINE - PRODUCT_ROUNDING;
}

// A bound below |n·d|/flatness, squared, over normals and offsets within boxes.
float bound_height2(vec3 normal_lo, vec3 normal_hi, vec3 d_lo, vec3 d_hi, float flatness) {
    vec3 least = find_least_products(normal_lo, normal_hi, d_lo, d_hi);
    vec3 most = find_most_products(normal_lo, normal_hi, d_lo, d_hi);
    vec3 far = max(abs(d_lo), abs(d_hi));
    float height = max(least.x + least.y + least.z, -(most.x + most.y + most.z));
    height = max(height - PRODUCT_ROUNDING * max(far.x, max(far.y, far.z)), 0.0) / max(flatness, 1e-20);
    return flatness > 0.0 ? height * height * (1.0 - 2.0 * PRODUCT_ROUNDING) : 0.0;
}
