// SPDX-License-Identifier: Apache-2.0
// Which photons lie on the same surface as a point, and how far they count as being (METHODS §2).

// Photons whose normal differs more belong to another surface.
const float SAME_SURFACE_COSINE = 0.7;

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
