// SPDX-License-Identifier: Apache-2.0
// Which photons lie on the same surface as a point, and how far they count as being (METHODS §2); bounds of both over
// boxes of photons.

// Photons whose normal differs more belong to another surface.
const float SAME_SURFACE_COSINE = 0.7;
// What rounding may do to a sum of three products, as a share of the largest.
const float PRODUCT_ROUNDING = 1e-6;

bool faces_alike(vec3 normal, vec3 other_normal) { return dot(other_normal, normal) > SAME_SURFACE_COSINE; }

// The normal, so long that its product with an offset is the radius the height asks for; 0: heights do not matter.
vec3 make_steep(vec3 normal, float flatness) { return flatness > 0.0 ? normal / flatness : vec3(0.0); }

// Square of the smallest radius r whose ball takes in a photon at offset `d`: |d| ≤ r and |n·d| ≤ flatness·r.
float measure_on_surface(vec3 d, vec3 steep_normal) {
    precise float squared = d.x * d.x + d.y * d.y + d.z * d.z;
    precise float radius = d.x * steep_normal.x + d.y * steep_normal.y + d.z * steep_normal.z;
    float by_height = radius * radius;
    return by_height > squared ? by_height : squared; // max() looks after NaN, at twice the cost
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

// A bound below the square of the radius that the height asks for, over offsets within the box.
float bound_height2(vec3 steep_normal, vec3 d_lo, vec3 d_hi) {
    vec3 a = steep_normal * d_lo, b = steep_normal * d_hi;
    vec3 least = min(a, b), most = max(a, b);
    vec3 far = max(abs(a), abs(b));
    float radius = max(least.x + least.y + least.z, -(most.x + most.y + most.z));
    radius = max(radius - PRODUCT_ROUNDING * max(far.x, max(far.y, far.z)), 0.0);
    return radius * radius * (1.0 - 2.0 * PRODUCT_ROUNDING);
}
