// SPDX-License-Identifier: Apache-2.0
// The photons of a map gather from each other, a subgroup of them at a time, one a lane: each finds its radius, the
// measure of the photon of rank K + 1, and hands everyone nearer to accumulate().
// Places are shared: photons at just the radius divide what is left of the K, so that no order of photons matters.
// A photon meets itself at measure 0 and must add nothing to its own sums.
//
// The kernel includes its candidates first and defines accumulate() (see photons/stream_members.glsl) and
// void clear_sums(). Defines: see photons/find_radius.glsl.
#include "photons/find_radius.glsl"
#include "photons/stream_members.glsl"

// Finds every lane's radius for `k` neighbours and sums its members. `guess2` is a squared radius that may be right.
// Without turns left at the end the result is not to be trusted.
void gather_members(bool has_query, uint photon_count, uint leaf_level, uint k, float guess2) {
    find_radius(has_query, photon_count, leaf_level, k, guess2);
    clear_sums();
    stream_members(has_query, photon_count, leaf_level, my_gathered.r2, my_gathered.tie_weight);
}
