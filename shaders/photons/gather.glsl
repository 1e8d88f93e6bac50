// SPDX-License-Identifier: Apache-2.0
// The photons of a map gather from each other, a subgroup of them at a time, one a lane: each finds its radius, the
// measure of the photon of rank K + 1, and hands everyone nearer to accumulate(). There is no list of k neighbours:
// what lies below a bracket is summed as it streams by, the few within the bracket (the shell) are ranked, and a
// bracket that missed is moved by what was counted. The radius is exact whatever bracket was tried first.
//
// Places are shared: photons at just the radius divide what is left of the K, so that no order of photons matters.
// A photon meets itself at measure 0 and must add nothing to its own sums.
//
// The kernel includes its candidates (photons/world_candidates.glsl, photons/parameter_candidates.glsl) first: Place,
// Candidate, my_place(), load_candidate, share_candidate, measure_candidate, measure_node_gap, measure_limit, and defines
// void accumulate(Candidate other, float weight) and void clear_sums().
// Defines: SHELL_SIZE (a power of two), SORT_NETWORK (its comparators EXCHANGE(i, j)), LOAD_SHELL (its values).
#include "photons/visit_tiles.glsl"
#include "photons/flagged.glsl"

// A bracket holds this share of the shell at first, so that most photons need one pass.
const float FIRST_FILL = 0.35;
const float NEXT_FILL = 0.3;
// Passes after which the bracket is halved bit by bit: 32 of those always end.
const uint PATIENCE = 6u;
const uint LARGEST_PASS_COUNT = 64u;
// A lane that has met more than this of what it seeks has reached too far and gives the pass up: beside a crowd an
// outlier's ball would take in all of it.
const uint CROWD_FACTOR = 8u;
const uint CROWD_BASE = 256u;
// Where nothing is known, the first radius tried, as a share of the largest.
const float SMALLEST_SHARE = 1e-12;

shared uint shell_places[SHELL_SIZE * gl_WorkGroupSize.x]; // tree positions
shared float shell_measures[SHELL_SIZE * gl_WorkGroupSize.x];

// One lane's search; counts include the photon itself.
struct Search {
    bool searching;
    float lo, hi;                    // measures this pass tells apart
    float below, above;              // known: fewer than wanted reach `below`, as many reach `above`
    uint below_count, above_count;
    uint lo_count, hi_count;         // of this pass
    uint shell_count;
};

// What was found.
struct Gathered {
    float r2;         // squared radius
    float members;    // K': neighbours counted
    float tie_weight; // of photons at just the radius
    uint others;      // photons the radius was found from, up to K + 1
};

Search my_search;
Gathered my_gathered;
bool is_cut_short; // the lane gave the last pass up: its counts are too low
uint map_size; // photons

void open_pass(bool searching, float limit) {
    my_search.hi = min(my_search.hi, limit);
    my_search.lo = min(my_search.lo, my_search.hi);
    if (searching) {
        my_search.lo_count = 0u;
        my_search.hi_count = 0u;
        my_search.shell_count = 0u;
        clear_sums();
    }
    set_batch(searching, my_search.hi);
}

// One span of candidates: those up to lo are summed, those up to hi flagged.
uint stream_span(Candidate mine, uint lane0) {
    uint flags = 0u;
    for (uint base = 0u; base < SPAN; base += 8u) {
#define TEST(c) { Candidate other = share_candidate(mine, lane0 + base + c); \
        float measure = measure_candidate(other); \
        bool inside = measure <= my_search.lo; \
        bool reached = measure <= my_search.hi; \
        accumulate(other, inside ? 1.0 : 0.0); \
        my_search.lo_count += uint(inside); \
        flags |= reached && !inside ? 1u << (base + c) : 0u; }
        TEST(0u) TEST(1u) TEST(2u) TEST(3u) TEST(4u) TEST(5u) TEST(6u) TEST(7u)
    }
    my_search.hi_count += bitCount(flags);
    return flags;
}

void visit_tile(uint next, uint end) {
    uint position = next + LANE;
    Candidate mine = load_candidate(min(position, map_size - 1u), position < end);
    for (uint lane0 = 0u; lane0 < min(WIDTH, TREE_LEAF_PHOTONS); lane0 += SPAN)
        store_flags(stream_span(mine, lane0), next + lane0);
}

// Moves what was flagged to the shell, as far as it fits.
void take_flagged(bool has, uint position) {
    float measure = measure_candidate(load_candidate(position, true));
    if (has && my_search.shell_count < SHELL_SIZE) {
        uint at = my_search.shell_count * WIDTH + LANE;
        shell_places[at] = position;
        shell_measures[at] = measure;
    }
    my_search.shell_count += uint(has);
}

// Walks the tree once for the lanes that search.
void run_pass(bool searching, uint wanted, uint photon_count, uint leaf_level, float limit) {
    // Lanes that are through accept nothing more; their sums and shells stay.
    Search kept = my_search;
    open_pass(searching, limit);
    float lo = my_search.lo, hi = my_search.hi;
    bool accepts = searching;
    is_cut_short = false;
    uint depth = leaf_level == 0u ? 0u : 1u;
    uint leaf_count = leaf_level == 0u ? 1u : 0u;
    start_walk();
    do {
        my_search.lo = accepts ? lo : -1.0;
        my_search.hi = accepts ? hi : -1.0;
        walk_tree(leaf_level, depth, leaf_count);
        begin_flags();
        visit_leaves(leaf_count, photon_count, leaf_level);
        bool is_crowded = my_search.lo_count + my_search.hi_count > CROWD_FACTOR * wanted + CROWD_BASE;
        if (accepts && is_crowded && depth > 0u) {
            accepts = false;
            is_cut_short = true;
            my_word_count = 0u; // nobody will rank them
        }
        visit_flagged();
        set_batch(accepts, hi);
        leaf_count = 0u;
        ++turns;
    } while (depth > 0u && subgroupAny(accepts) && has_turns_left());
    my_search.lo = lo;
    my_search.hi = hi;
    my_search.hi_count += my_search.lo_count;
    if (!searching) my_search = kept;
}

// What a pass that missed has taught.
void learn_counts(uint wanted) {
    if (my_search.lo_count < wanted) {
        if (my_search.lo >= my_search.below && !is_cut_short) {
            my_search.below = my_search.lo;
            my_search.below_count = my_search.lo_count;
        }
    } else if (my_search.lo < my_search.above) {
        my_search.above = my_search.lo;
        my_search.above_count = my_search.lo_count;
    }
    if (my_search.hi_count < wanted && !is_cut_short) {
        my_search.below = my_search.hi;
        my_search.below_count = my_search.hi_count;
    } else if (my_search.hi_count >= wanted && my_search.hi < my_search.above) {
        my_search.above = my_search.hi;
        my_search.above_count = my_search.hi_count;
    }
}

// A bracket that should leave few photons to rank, if each takes up as much of the measure as told.
void aim_bracket(float target, float each) {
    float reach = each * float(SHELL_SIZE) * NEXT_FILL;
    my_search.lo = max(target - reach, my_search.below);
    my_search.hi = min(target + reach, my_search.above);
}

// The next bracket, from what is known. Photons lie on surfaces: counts grow with the squared radius.
void choose_bracket(uint wanted, uint pass, float limit) {
    float below = max(my_search.below, 0.0);
    bool is_open = my_search.above == INFINITY;
    if (is_open && 4u * my_search.below_count > wanted && pass < 2u) {
        float each = below / float(my_search.below_count);
        aim_bracket(each * (float(wanted) - 0.5), each);
    } else if (is_open) {
        float scale = 1.4 * float(wanted) / float(max(my_search.below_count, 1u));
        my_search.lo = my_search.below;
        my_search.hi = max(below * clamp(scale, 1.5, 16.0), limit * SMALLEST_SHARE);
    } else if (is_cut_short) {
        my_search.lo = my_search.below;
        my_search.hi = below > 0.0 ? sqrt(below) * sqrt(my_search.above) : my_search.above / 16.0;
    } else if (my_search.above_count - my_search.below_count <= SHELL_SIZE) {
        my_search.lo = my_search.below;
        my_search.hi = my_search.above;
    } else if (pass > PATIENCE) {
        uint middle = (floatBitsToUint(below) + floatBitsToUint(my_search.above)) / 2u;
        my_search.lo = my_search.below < 0.0 ? 0.0 : uintBitsToFloat(middle);
        my_search.hi = my_search.above;
    } else {
        float span = my_search.above - below;
        float each = span / float(my_search.above_count - my_search.below_count);
        // Where counts do not grow evenly the middle does better than what they point at.
        bool halves = pass > 2u && pass % 2u == 0u;
        aim_bracket(below + (halves ? 0.5 * span : each * (float(wanted - my_search.below_count) - 0.5)), each);
    }
}

#define EXCHANGE(i, j) { float low = min(value[i], value[j]); value[j] = max(value[i], value[j]); value[i] = low; }

// Ranks the shell: the radius, and how many share it.
void rank_shell(uint rank) {
    uint stored = min(my_search.shell_count, SHELL_SIZE);
    float value[SHELL_SIZE];
    LOAD_SHELL
    SORT_NETWORK
    uint wanted = rank - my_search.lo_count - 1u;
    float r2 = value[SHELL_SIZE - 1u];
    for (uint i = 0u; i < SHELL_SIZE; ++i) r2 = i == wanted ? value[i] : r2;
    uint nearer = my_search.lo_count, equal = 0u;
    for (uint i = 0u; i < SHELL_SIZE; ++i) {
        nearer += uint(value[i] < r2);
        equal += uint(value[i] == r2);
    }
    // The photon itself stands among the nearer ones, or, where all coincide, among the equal.
    float taken = float(nearer) - (r2 > 0.0 ? 1.0 : 0.0);
    float sharing = float(equal) - (r2 > 0.0 ? 0.0 : 1.0);
    float members = max(float(rank) - 2.0, 1.0); // the other of two gives the radius and is a member
    my_gathered = Gathered(r2, members, sharing > 0.0 ? (members - taken) / sharing : 0.0, rank - 1u);
}

// Adds the shell's members to the sums.
void accumulate_shell(bool has_query) {
    uint count = has_query ? min(my_search.shell_count, SHELL_SIZE) : 0u;
    uint most = subgroupMax(count);
    for (uint i = 0u; i < most; ++i) {
        ++turns;
        bool valid = i < count;
        uint at = i * WIDTH + LANE;
        float measure = shell_measures[at];
        Candidate other = load_candidate(valid ? shell_places[at] : 0u, true);
        float weight = measure < my_gathered.r2 ? 1.0 : (measure == my_gathered.r2 ? my_gathered.tie_weight : 0.0);
        accumulate(other, valid ? weight : 0.0);
    }
}

// Finds every lane's radius for `k` neighbours and sums its members. `guess2` is a squared radius that may be right.
// Without turns left at the end the result is not to be trusted.
void gather_members(bool has_query, uint photon_count, uint leaf_level, uint k, float guess2) {
    uint wanted = k + 2u; // the photon itself, k neighbours, and the one that gives the radius
    float limit = measure_limit();
    float reach = min(FIRST_FILL * float(SHELL_SIZE) / float(wanted), 0.6);
    my_search = Search(has_query, guess2 * (1.0 - reach), guess2 * (1.0 + reach), -1.0, INFINITY, 0u, 0u, 0u, 0u, 0u);
    uint rank = wanted; // fewer photons than wanted: the farthest's
    uint pass = 0u;
    map_size = photon_count;
    clear_sums();
    do {
        run_pass(my_search.searching, wanted, photon_count, leaf_level, limit);
        if (my_search.searching && !is_cut_short && my_search.hi >= limit && my_search.hi_count < rank) {
            rank = my_search.hi_count;
            my_search.below = -1.0;
            my_search.below_count = 0u;
        }
        bool within = my_search.lo_count < rank && rank <= my_search.hi_count;
        // Nothing lies between neighboring floats: more than a shell of photons tie.
        bool is_narrow = floatBitsToUint(my_search.hi) - floatBitsToUint(max(my_search.lo, 0.0)) <= 1u;
        bool found = within && !is_cut_short && (my_search.shell_count <= SHELL_SIZE || is_narrow);
        bool searched = my_search.searching;
        my_search.searching = searched && !found;
        if (my_search.searching) {
            learn_counts(rank);
            choose_bracket(rank, pass, limit);
        }
        ++pass;
        ++turns;
    } while (subgroupAny(my_search.searching) && has_turns_left() && pass < LARGEST_PASS_COUNT);
    rank_shell(max(rank, my_search.lo_count + 1u));
    accumulate_shell(has_query);
}
