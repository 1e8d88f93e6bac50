// SPDX-License-Identifier: Apache-2.0
// Whether many photons have just the same parameters, found by looking at those that stand beside each other in the
// tree: a parameter with few values (a signature) would else make every photon look through all that share its own.

// Photons looked at, as a multiple of those sought.
const uint COINCIDENT_SPAN = 4u;

// True where at least k others measure 0 among those nearby in tree order; only lanes with `suspects` ask.
bool has_coincident(bool suspects, uint position, uint photon_count, uint k) {
    uint span = min(COINCIDENT_SPAN * (k + 1u) / WIDTH + 1u, photon_count / WIDTH + 1u);
    uint middle = subgroupMin(position) / WIDTH;
    uint first = WIDTH * (middle - min(middle, span / 2u));
    uint count = 0u;
    uint tiles = subgroupAny(suspects) ? span : 0u;
    for (uint tile = 0u; tile < tiles; ++tile) {
        turns += WIDTH + 1u;
        uint at = first + tile * WIDTH + LANE;
        Candidate mine = load_candidate(min(at, photon_count - 1u), at < photon_count);
        for (uint lane = 0u; lane < WIDTH; ++lane) count += uint(measure_candidate(share_candidate(mine, lane)) == 0.0);
    }
    return suspects && count > k;
}
