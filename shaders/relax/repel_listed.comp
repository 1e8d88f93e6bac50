// SPDX-License-Identifier: Apache-2.0
// One step of relaxation as in relax/repel_photons.comp, but from lists of candidates that live for several steps: a
// list holds all that were within a reach when it was made. A subgroup makes its lists anew when what its photons have
// moved since could have brought in another; how far others moved is judged by the subgroup's own photons, so that
// this search is not exact (docs/relaxation.md says how far off).
// Inputs and outputs as there, and: lists (LIST_SIZE tree positions a photon), list_states (xyz where the photon was,
// w squared reach, 0: no list), list_counts; unanswered (1: a list did not fit).
// Defines: LIST_SIZE, EACH_ENTRY(DO) (DO(i) for every entry), SORT_NETWORK, and those of photons/world_candidates.glsl.
#include "shared/prelude.glsl"
#include "relax/repulsion.glsl"
#include "photons/visit_tiles.glsl"
#include "photons/flagged.glsl"
#include "photons/each_photon.glsl"
#pragma binding coherent uint lists
#pragma binding coherent vec4 list_states
#pragma binding coherent uint list_counts
#pragma binding coherent float radii
#pragma binding writeonly vec4 moves

// A list is made for this share of its size, so that uneven density does not overflow it.
const float LIST_FILL = 0.72;
// Others may have moved this much farther than the farthest of the subgroup.
const float OTHERS_MOVE = 1.25;
const uint LARGEST_ATTEMPT_COUNT = 16u;

float my_list_reach2;
uint my_list_count;
bool makes_list;
uint my_slot; // of this subgroup's lists

uint locate_entry(uint i) { return (my_slot * LIST_SIZE + i) * WIDTH + LANE; }

void visit_tile(uint next, uint end) {
    uint position = next + LANE;
    Candidate mine = load_candidate(min(position, settings.gather.photon_count - 1u), position < end);
    for (uint lane0 = 0u; lane0 < min(WIDTH, TREE_LEAF_PHOTONS); lane0 += SPAN) {
        uint flags = 0u;
        for (uint base = 0u; base < SPAN; base += 8u) {
#define FLAG(c) { float measure = measure_candidate(share_candidate(mine, lane0 + base + c)); \
            flags |= measure <= my_list_reach2 ? 1u << (base + c) : 0u; }
            FLAG(0u) FLAG(1u) FLAG(2u) FLAG(3u) FLAG(4u) FLAG(5u) FLAG(6u) FLAG(7u)
        }
        store_flags(makes_list ? flags : 0u, next + lane0);
    }
}

uint my_position;

void take_flagged(bool has, uint position) {
    bool counts = has && position != my_position;
    if (counts && my_list_count < LIST_SIZE) lists[locate_entry(my_list_count)] = position;
    my_list_count += uint(counts);
}

void walk_lists(bool makes) {
    makes_list = makes;
    my_list_count = makes ? 0u : my_list_count;
    set_batch(makes, my_list_reach2);
    uint depth = settings.gather.leaf_level == 0u || !subgroupAny(makes) ? 0u : 1u;
    uint leaf_count = settings.gather.leaf_level == 0u && subgroupAny(makes) ? 1u : 0u;
    start_walk();
    do {
        walk_tree(settings.gather.leaf_level, depth, leaf_count);
        begin_flags();
        visit_leaves(leaf_count, settings.gather.photon_count, settings.gather.leaf_level);
        visit_flagged();
        leaf_count = 0u;
        ++turns;
    } while (depth > 0u && has_turns_left());
}

// Makes the lists of a subgroup; false where one does not come out right.
bool make_lists(bool wanted, float guess2) {
    uint k = settings.gather.k;
    float limit = measure_limit();
    float target = LIST_FILL * float(LIST_SIZE);
    my_list_reach2 = min(guess2 * target / float(k + 1u), limit);
    bool searching = wanted;
    uint attempt = 0u;
    while (subgroupAny(searching) && attempt < LARGEST_ATTEMPT_COUNT && has_turns_left()) {
        walk_lists(searching);
        bool fits = my_list_count <= LIST_SIZE;
        bool suffices = my_list_count >= k + 2u || my_list_reach2 >= limit;
        searching = searching && !(fits && suffices);
        float scale = clamp(target / float(max(my_list_count, 1u)), 0.1, 8.0);
        if (searching) my_list_reach2 = min(max(my_list_reach2 * scale, limit * 1e-12), limit);
        ++attempt;
    }
    return !searching;
}

#define EXCHANGE(i, j) { float low = min(sorted[i], sorted[j]); sorted[j] = max(sorted[i], sorted[j]); sorted[i] = low; }

// The radius from the list, and the sums over its members.
Reach sum_list() {
    uint k = settings.gather.k;
    Place offset[LIST_SIZE];
    float value[LIST_SIZE];
    float sorted[LIST_SIZE];
    uint count = my_list_count;
#ifdef FLAT_AXES
#define MEASURE_ENTRY(place, d) square_length(d)
#else
#define MEASURE_ENTRY(place, d) measure_on_surface(d, my_normal, tree_normals_at(place).xyz, my_flatness)
#endif
#define LOAD_ENTRY(i) { uint place = min(lists[locate_entry(uint(i))], settings.gather.photon_count - 1u); \
    offset[i] = wrap_offset(take_place(tree_positions_at(place)) - my_photon.place); \
    value[i] = uint(i) < count ? MEASURE_ENTRY(place, offset[i]) : INFINITY; \
    sorted[i] = value[i]; }
    EACH_ENTRY(LOAD_ENTRY)
    SORT_NETWORK
    uint found = 0u;
#define COUNT_ENTRY(i) found += uint(value[i] < INFINITY);
    EACH_ENTRY(COUNT_ENTRY)
    uint rank = min(k + 1u, found);
    float r2 = 0.0;
#define PICK_ENTRY(i) r2 = uint(i) + 1u == rank ? sorted[i] : r2;
    EACH_ENTRY(PICK_ENTRY)
    uint nearer = 0u, equal = 0u;
#define RANK_ENTRY(i) nearer += uint(value[i] < r2); equal += uint(value[i] == r2);
    EACH_ENTRY(RANK_ENTRY)
    float members = max(float(rank) - 1.0, 1.0);
    float tie = equal > 0u ? (members - float(nearer)) / float(equal) : 0.0;
    clear_sums();
    coincident_sum = 1.0; // the photon itself
#define SUM_ENTRY(i) { float weight = value[i] < r2 ? 1.0 : (value[i] == r2 ? tie : 0.0); \
    float distance = sqrt(square_length(offset[i])); bool apart = distance > 0.0; \
    near_sum -= offset[i] * (apart ? weight / distance : 0.0); \
    far_sum -= weight > 0.0 ? offset[i] * (weight * distance) : Place(0.0); \
    coincident_sum += apart ? 0.0 : weight; }
    EACH_ENTRY(SUM_ENTRY)
    return Reach(r2, members, rank);
}

void main() {
    for (uint batch = 0u; batch < BATCH_COUNT(settings.gather); ++batch) {
        bool has_photon = take_turn(settings.gather, batch, my_position);
        my_slot = my_position / WIDTH;
        take_photon(my_position, settings.gather.period, settings.gather.flatness);
        float guess2 = radii[my_position] * settings.gather.carry;
        if (guess2 <= 0.0)
            guess2 = guess_radius2(settings.gather.photon_count, settings.gather.leaf_level, my_position, settings.gather.k);
        vec4 state = list_states[my_position];
        my_list_count = list_counts[my_position];
        my_list_reach2 = state.w;
        float moved = sqrt(square_length(my_photon.place - take_place(state)));
        float margin = moved + OTHERS_MOVE * subgroupMax(has_photon ? moved : 0.0);
        bool holds = sqrt(guess2) + margin <= sqrt(state.w) && state.w > 0.0;
        bool remakes = !subgroupAll(holds || !has_photon);
        bool is_right = make_lists(has_photon && remakes, guess2);
        Reach reach = sum_list();
        vec4 move = find_move(my_position, reach);
        if (has_photon) {
            if (remakes) {
                list_states[my_position] = vec4(tree_positions_at(my_position).xyz, my_list_reach2);
                list_counts[my_position] = min(my_list_count, LIST_SIZE);
            }
            moves[my_position] = move;
            radii[my_position] = reach.r2;
        }
        report_turn(has_photon, is_right && has_turns_left(), my_position);
    }
}
