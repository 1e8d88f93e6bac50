// SPDX-License-Identifier: Apache-2.0
// Large nodes, step 1 of 5: the axis, and between which two sampled keys the median is sought; one subgroup a node. A
// bracket that missed the median, or holds too much, narrows down where it is, and samples are taken there.
// Inputs: source, range_rows, scales, tree_nodes. In and out: brackets. Scratch: candidates. Define: RANGE_ROWS.
#include "shared/prelude.glsl"
#define LISTED
#include "photons/large_nodes.glsl"
#include "photons/choose_axis.glsl"

// Samples a node, at most; what a subgroup sorts out in little time.
const uint LARGEST_SAMPLE = 4096u;
// Photons read for it: where few are within the limits many are passed over.
const uint MOST_READ = 1u << 17u; // twice; shared/turns.glsl
// Deviations of a random sample's median between which it is sought.
const float DEVIATIONS = 4.0;
const uint MOST_PASSES = 26u; // as in split_nodes.comp

TreeBracket start_bracket(uint heap, uint first, uint n) {
    uvec4 all = uvec4(uint(LEAST.value), uint(LEAST.place), uint(GREATEST.value), uint(GREATEST.place));
    return TreeBracket(all, all, choose_axis_of(heap, first, n), 0u, 0u, 0u, n, 0u, 0u, 0u);
}

// Where the key of that rank is by what was counted.
void narrow(inout TreeBracket bracket, uint rank) {
    uint behind = bracket.below + bracket.kept;
    if (rank < bracket.below) {
        bracket.least_greatest.zw = bracket.lo_hi.xy;
        bracket.within = bracket.below - bracket.below_least;
    } else if (rank >= behind) {
        bracket.least_greatest.xy = bracket.lo_hi.zw;
        bracket.within = bracket.below_least + bracket.within - behind;
        bracket.below_least = behind;
    } else {
        bracket.least_greatest = bracket.lo_hi;
        bracket.within = bracket.kept;
        bracket.below_least = bracket.below;
    }
}

// Appends places to the candidates of the node that begins at `first`.
void keep(uint place, bool is_kept, uint first, inout uint kept) {
    uvec2 ballot = find_lanes(is_kept);
    if (is_kept) candidates[first + kept + count_before(ballot)] = place;
    kept += count_lanes(ballot);
}

// Evenly spaced photons' keys between the limits become candidates.
uint sample_keys(uint first, uint n, TreeBracket bracket, uint samples) {
    Key least = Key(int(bracket.least_greatest.x), int(bracket.least_greatest.y));
    Key greatest = Key(int(bracket.least_greatest.z), int(bracket.least_greatest.w));
    uint kept = 0u;
    for (uint i = 0u; i < samples; i += WIDTH) {
        // Other rounds take other photons.
        uint place = first + min(find_spaced(n, i + LANE, samples) + build.round * 7u % (n / samples), n - 1u);
        Key key = read_source(place, bracket.axis);
        keep(place, !is_less(key, least) && is_less(key, greatest), first, kept);
    }
    subgroupMemoryBarrierBuffer();
    subgroupBarrier();
    return kept;
}

Key find_sample(uint first, uint n, uint kept, uint rank, uint axis) {
    return find_ranked(Search(first, first + kept, axis, rank, int(first), int(first + n)), MOST_PASSES);
}

void main() {
    uint node = gl_WorkGroupID.x;
    uint first = find_first_position(build.photon_count, node, build.level);
    uint n = find_first_position(build.photon_count, node + 1u, build.level) - first;
    uint rank = find_split(node) - first;
    TreeBracket bracket = brackets[node];
    if (build.round > 0u && bracket.is_settled != 0u) return;
    if (build.round == 0u) bracket = start_bracket((1u << build.level) + node, first, n);
    else narrow(bracket, rank);
    bracket.lo_hi = bracket.least_greatest;
    uint samples = 1u << findMSB(min(n / 16u, min(LARGEST_SAMPLE * (n / max(bracket.within, 1u)), MOST_READ)));
    uint kept = sample_keys(first, n, bracket, samples);
    float wanted = (float(rank - bracket.below_least) + 0.5) / float(bracket.within) * float(kept);
    float margin = DEVIATIONS * 0.5 * sqrt(float(kept)) + 1.0;
    if (wanted - margin >= 0.0) {
        Key lo = find_sample(first, n, kept, uint(wanted - margin), bracket.axis);
        bracket.lo_hi.xy = uvec2(uint(lo.value), uint(lo.place));
    }
    if (wanted + margin < float(kept)) {
        Key hi = find_sample(first, n, kept, uint(wanted + margin), bracket.axis);
        bracket.lo_hi.zw = uvec2(uint(hi.value), uint(hi.place));
    }
    bracket.below = bracket.kept = 0u;
    if (LANE == 0u) brackets[node] = bracket;
}
