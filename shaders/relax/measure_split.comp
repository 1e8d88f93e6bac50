// SPDX-License-Identifier: Apache-2.0
// The `split` descriptor (METHODS §5.4, after [SJ09]): along the mean offset δ the neighbours' signed distances ψ are
// sorted, with -r and r at the ends; the gap that leaves the evenest gaps on both its sides is where an edge may be.
// A subgroup takes one photon at a time. Inputs: the tree, offsets and member_radii of relax/measure_moments.comp, with
// SINGLY singles. Outputs: constraint_along, constraint_across, unanswered (a flag a photon, or a single one, set
// beforehand). In and out, with SINGLY: saved_lists, where a photon's turns did not suffice.
#include "shared/prelude.glsl"
#include "shared/relax.h"
#include "relax/tangent_plane.glsl"
#define ONE_QUERY
#include "photons/visit_tiles.glsl"
#include "relax/write_constraint.glsl"
#pragma binding texel offsets
#pragma binding texel member_radii
#pragma binding writeonly uint unanswered
#pragma binding readonly uvec2 singles
#pragma binding coherent uint saved_lists

layout(push_constant) uniform Push { DescribeSettings settings; };

const uint LIST_SIZE = 1024u; // a power of two above the most neighbours and both ends
const uint SORT_TURNS = 10000u; // of the longest list and what follows
const uint FEWEST_GAPS = 8u;  // on each side, or their evenness says nothing

shared float signed_distances[LIST_SIZE];

void synchronize() {
    subgroupMemoryBarrierShared();
    subgroupBarrier();
}

vec2 my_direction;
float my_r2;
uint my_position;
uint my_slot; // with SINGLY
uint listed;

// Each lane looks at its own photon of the tile; those at just the radius are as good as the end there.
void list_tile(uint next, uint end) {
    uint position = next + LANE;
    Candidate other = load_candidate(min(position, settings.gather.photon_count - 1u), position < end);
    Place d = find_offset(other);
    bool is_self = position == my_position;
    bool is_member = measure_candidate(other) < my_r2 && !is_self;
    uvec2 ballot = find_lanes(is_member);
    uint at = min(listed + count_before(ballot), LIST_SIZE - 1u);
    if (is_member) signed_distances[at] = dot(my_direction, project_offset(d));
    listed += count_lanes(ballot);
}

DEFINE_VISIT(list_leaves, list_tile)

// Bitonic sort of the list, padded to a power of two.
uint sort_list(uint count) {
    uint padded = 1u;
    while (padded < count) padded <<= 1u;
    for (uint i = count + LANE; i < padded; i += WIDTH) signed_distances[i] = INFINITY;
    synchronize();
    for (uint size = 2u; size <= padded; size <<= 1u)
        for (uint gap = size >> 1u; gap > 0u; gap >>= 1u) {
            turns += padded / (2u * WIDTH) + 2u;
            for (uint pair = LANE; pair < padded / 2u; pair += WIDTH) {
                uint low = 2u * gap * (pair / gap) + pair % gap;
                float a = signed_distances[low], b = signed_distances[low + gap];
                bool swap = (b < a) == ((low & size) == 0u);
                signed_distances[low] = swap ? b : a;
                signed_distances[low + gap] = swap ? a : b;
            }
            synchronize();
        }
    return padded;
}

// Weight, weighted gap and weighted squared gap; a disc is thin near its ends, so gaps there count little.
vec3 weigh_gap(uint gap, float r) {
    float a = signed_distances[gap], b = signed_distances[gap + 1u];
    float middle = 0.5 * (a + b) / r;
    float weight = max(1.0 - middle * middle, 0.0);
    float size = (b - a) / r;
    return vec3(weight, weight * size, weight * size * size);
}

// Mean gap, and deviation over mean.
vec2 find_evenness(vec3 sums) {
    float mean = sums.x > 0.0 ? sums.y / sums.x : 0.0;
    float variance = sums.x > 0.0 ? max(sums.z / sums.x - mean * mean, 0.0) : 0.0;
    return vec2(mean, mean > 0.0 ? sqrt(variance) / mean : 0.0);
}

// Weight of the constraint from the best split; every lane takes a run of gaps.
float weigh_split(uint gap_count, float r) {
    uint run = (gap_count + WIDTH - 1u) / WIDTH;
    uint first = min(LANE * run, gap_count), end = min(first + run, gap_count);
    turns += 2u * run + 4u;
    vec3 own = vec3(0.0);
    for (uint gap = first; gap < end; ++gap) own += weigh_gap(gap, r);
    vec3 total = sum_lanes(own);
    vec3 left = sum_before(own);
    float best = INFINITY;
    uint best_gap = 0u;
    vec2 best_means = vec2(0.0);
    for (uint gap = first; gap < end; ++gap) {
        vec3 here = weigh_gap(gap, r);
        vec2 before = find_evenness(left);
        vec2 after = find_evenness(total - left - here);
        float unevenness = before.y + after.y;
        bool counts = gap >= FEWEST_GAPS && gap + FEWEST_GAPS < gap_count;
        bool better = counts && unevenness < best;
        best = better ? unevenness : best;
        best_gap = better ? gap : best_gap;
        best_means = better ? vec2(before.x, after.x) : best_means;
        left += here;
    }
    bool is_best = best < INFINITY && best == find_least(best);
    uvec2 ballot = find_lanes(is_best);
    if (count_lanes(ballot) == 0u) return 0.0;
    uint winner = find_first_lane(ballot); // runs ascend with the lanes: the first split of those that tie
    uint gap = broadcast(best_gap, winner);
    vec2 means = vec2(broadcast(best_means.x, winner), broadcast(best_means.y, winner));
    float middle = 0.5 * (signed_distances[gap] + signed_distances[gap + 1u]) / r;
    float larger = max(means.x, means.y);
    float homogeneity = larger > 0.0 ? min(means.x, means.y) / larger : 1.0;
    bool is_near = abs(middle) <= 0.5 * (means.x + means.y);
    return is_near ? ramp(homogeneity, settings.free_at, settings.fixed_at) : 0.0;
}

#ifdef SINGLY
const uint SAVED_WORDS = 10u + LIST_SIZE; // engine/photons/gather.cpp

bool resume_list() {
    uint at = SAVED_WORDS * my_slot;
    if (saved_lists[at] == 0u) return false;
    walk = Walk(saved_lists[at + 1u], saved_lists[at + 2u], saved_lists[at + 3u], saved_lists[at + 4u],
                uvec3(saved_lists[at + 5u], saved_lists[at + 6u], saved_lists[at + 7u]), saved_lists[at + 8u]);
    listed = saved_lists[at + 9u];
    turns += listed / WIDTH + 1u;
    for (uint i = LANE; i < min(listed, LIST_SIZE); i += WIDTH)
        signed_distances[i] = uintBitsToFloat(saved_lists[at + 10u + i]);
    return true;
}

void save_list() {
    uint at = SAVED_WORDS * my_slot;
    uint words[10] = uint[10](1u, walk.step, walk.node, walk.last_step, walk.first_levels, walk.waiting.x, walk.waiting.y,
                              walk.waiting.z, walk.leaves, listed);
    for (uint i = 0u; i < 10u && LANE == 0u; ++i) saved_lists[at + i] = words[i];
    synchronize();
    for (uint i = LANE; i < min(listed, LIST_SIZE); i += WIDTH)
        saved_lists[at + 10u + i] = floatBitsToUint(signed_distances[i]);
}
#else
bool resume_list() { return false; }
void save_list() {}
#endif

// False where the turns did not suffice.
bool list_neighbors(uint photon_count, uint leaf_level) {
    listed = 0u;
    lane_reach = my_r2;
    if (!resume_list()) start_walk(leaf_level);
    do {
        list_leaves(photon_count, leaf_level);
        walk_on();
        ++turns;
    } while (!is_walk_over() && has_turns_left());
    if (!is_walk_over()) save_list();
    return is_walk_over();
}

void main() {
    uint at = settings.gather.first + gl_WorkGroupID.x;
    if (gl_WorkGroupID.x >= settings.gather.count) return;
#ifdef SINGLY
    uint position = singles[at].x;
    my_slot = at = singles[at].y;
#else
    uint position = at;
#endif
    turn_limit = TURN_BUDGET - SORT_TURNS;
    my_position = position;
    take_query(position, settings.gather.period, settings.gather.flatness);
    set_tangents();
    vec4 own = offsets_at(position);
    vec2 mean = project_vector(own.xyz);
    my_r2 = member_radii_at(position).x;
    float r = sqrt(my_r2);
    float size = max(abs(mean.x), abs(mean.y));
    my_direction = size > 0.0 ? normalize(mean / size) : vec2(0.0);
    if (!list_neighbors(settings.gather.photon_count, settings.gather.leaf_level)) return;
    if (LANE == 0u) {
        signed_distances[min(listed, LIST_SIZE - 1u)] = -r;
        signed_distances[min(listed + 1u, LIST_SIZE - 1u)] = r;
    }
    uint count = min(listed + 2u, LIST_SIZE);
    synchronize();
    sort_list(count);
    float weight = weigh_split(count - 1u, r);
    if (size == 0.0 || r == 0.0) weight = 0.0;
    if (LANE == 0u) {
        write_constraint(position, own.w, mean, mean, weight);
        unanswered[at] = 0u;
    }
}
