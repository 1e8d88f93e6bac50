// SPDX-License-Identifier: Apache-2.0
// What a photon that repels or describes its neighbours makes of a radius: the photon of the rank gives the radius, the
// others but itself are members, and those at just the radius share what is left of the rank, so that no order of
// photons matters.

vec4 share_ties(float r2, uint rank, uint nearer, uint equal) {
    // The photon itself stands among the nearer ones, or, where all coincide, among the equal.
    float taken = float(nearer) - (r2 > 0.0 ? 1.0 : 0.0);
    float sharing = float(equal) - (r2 > 0.0 ? 0.0 : 1.0);
    float members = max(float(rank) - 2.0, 1.0); // the other of two gives the radius and is a member
    return vec4(r2, sharing > 0.0 ? (members - taken) / sharing : 0.0, members, float(max(rank, 1u) - 1u));
}
