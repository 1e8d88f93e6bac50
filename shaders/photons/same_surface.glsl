// SPDX-License-Identifier: Apache-2.0
// Which photons lie on the same surface as a point, and how far they count as being (METHODS §2); bounds of both over
// boxes of photons.

// Photons whose normal differs more belong to another surface.
const float SAME_SURFACE_COSINE = 0.7;
// What rounding may do to a sum of three products, as a share of the largest.
const float PRODUCT_ROUNDING = 1e-6;

bool faces_alike(vec3 normal, vec3 other_normal) { return dot(other_normal, normal) > SAME_SURFACE_COSINE; }

// Square of the smallest radius r whose ball takes in a photon at offset `d`: |d| ≤ r and |n·d| ≤ flatness·r. No test of
// the height when flatness is 0.
float measure_on_surface(vec3 d, vec3 normal, float flatness) {
    precise float squared = d.x * d.x + d.y * d.y + d.z * d.z;
    float height = flatness > 0.0 ? dot(normal, d) / flatness : 0.0;
    return max(squared, height * height);
}

// The measure is at most this for photons at that squared distance.
float limit_measure(float distance2, float flatness) {
    return flatness > 0.0 ? distance2 / min(1.0, flatness * flatness) : distance2;
}

// Whether a normal within the box may face alike.
bool may_face_alike(vec3 normal, vec3 lo, vec3 hi) {
    vec3 most = max(normal * lo, normal * hi);
    return most.x + most.y + most.z > SAME_SURFACE_COSINE - PRODUCT_ROUNDING;
}

// A bound below |n·d|/flatness, squared, over offsets within the box.
float bound_height2(vec3 normal, vec3 d_lo, vec3 d_hi, float flatness) {
    vec3 a = normal * d_lo, b = normal * d_hi;
    vec3 least = min(a, b), most = max(a, b);
    vec3 far = max(abs(d_lo), abs(d_hi));
    float height = max(least.x + least.y + least.z, -(most.x + most.y + most.z));
    height = max(height - PRODUCT_ROUNDING * max(far.x, max(far.y, far.z)), 0.0) / max(flatness, 1e-20);
    return flatness > 0.0 ? height * height * (1.0 - 2.0 * PRODUCT_ROUNDING) : 0.0;
}
