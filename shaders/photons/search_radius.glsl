// SPDX-License-Identifier: Apache-2.0
// The radius of each query of a batch, one a lane: the measure of the candidate of a rank. There is no list of that
// many: what lies below a bound is counted as it streams by, and the few above it that are nearest (the shell) are kept
// in order in registers. A bound that was wrong is moved by what was counted; the radius is exact whatever bound was
// tried first. On processors without branches a register is far cheaper than shared memory.
// A photon that asks meets itself at measure 0 and counts.
//
// Radii are vec4s. As a rule: squared radius, weight of photons at just that radius (they share what is left of the
// rank), members, photons found but for the query's own. With CUT_TIES every member counts whole: squared radius, what
// break_tie() and the id of a photon at just that radius must lie below (bits), photons found.
// Queries that this does not suit, such as where many photons tie or the turns do not suffice, are left to
// photons/select_radius.comp.
// Defines: SHELL_SIZE, and EACH_KEPT(DO), the calls DO(0) … DO(SHELL_SIZE - 1): what is not indexed by a constant
// would lie in memory.
#include "photons/visit_tiles.glsl"
#include "photons/radii.glsl"

// Of the shell, this share lies below the radius that was guessed.
const float FIRST_FILL = 0.5;
// Passes after which the bound is halved bit by bit, and after which the query is left to others.
const uint PATIENCE = 6u;
const uint LARGEST_PASS_COUNT = 14u;
// Where nothing is known, the first radius tried, as a share of the largest.
const float SMALLEST_SHARE = 1e-12;
const float SMALLEST_MEASURE = 1e-37; // still a normal float
// A lane that has met more than this of what it seeks has reached too far and gives the pass up: beside a crowd an
// outlier's ball would take in all of it.
const uint CROWD_FACTOR = 8u;
const uint CROWD_BASE = 256u;

// One lane's search; counts include the photon itself.
struct Search {
    bool searching;
    float lo, hi;                    // measures up to lo are counted, those up to hi are all met
    float below, above;              // known: fewer than wanted reach `below`, as many reach `above`
    uint below_count, above_count;
    uint lo_count, hi_count;         // of this pass
    bool counts_ties;                // this pass counts those that tie at lo, of which more than a shell were met …
    uint nearer;                     // … with so many nearer
    float nearest;                   // the least measure met, or about it …
    uint nearest_at;                 // … and the tree position of that photon
};

Search my_search;
vec4 my_radius;
bool is_settled; // it is the query's
// The least measures above lo, ascending, as bits: of floats that are not negative these are in the same order, and
// whole numbers have a least and a greatest without a second thought for NaN.
uint shell[SHELL_SIZE];
const uint NO_MEASURE = 0x7f800000u;
uint least_met;          // of this pass, as bits
uint least_tile;         // and where it was met
bool is_cut_short;       // the lane gave the last pass up: its counts are too low
uint map_size;           // photons
bool includes_last;      // with CUT_TIES: the candidate of the rank is a member itself

#define KEEP(i) { uint smaller = min(shell[i], rest); rest = max(shell[i], rest); shell[i] = smaller; }

void count_tile(uint next, uint end) {
    uint position = next + LANE;
    Candidate mine = load_candidate(min(position, map_size - 1u), position < end);
    for (uint base = 0u; base < min(WIDTH, TREE_LEAF_PHOTONS); base += 8u) {
#define COUNT(c) { float measure = measure_candidate(share_candidate(mine, base + c)); \
        bool inside = measure <= my_search.lo; \
        my_search.lo_count += uint(inside); \
        my_search.hi_count += uint(measure <= my_search.hi); \
        bool is_least = floatBitsToUint(measure) < least_met; \
        least_met = is_least ? floatBitsToUint(measure) : least_met; \
        least_tile = is_least ? next + base + c : least_tile; \
        uint rest = inside ? NO_MEASURE : floatBitsToUint(measure); \
        EACH_KEPT(KEEP) }
        COUNT(0u) COUNT(1u) COUNT(2u) COUNT(3u) COUNT(4u) COUNT(5u) COUNT(6u) COUNT(7u)
    }
}

DEFINE_VISIT(count_leaves, count_tile)

// Walks the tree once for the lanes that search.
void count_pass(bool searching, uint wanted, uint photon_count, uint leaf_level) {
    float lo = my_search.lo, hi = my_search.hi;
    Search kept = my_search;
    my_search.lo_count = 0u;
    my_search.hi_count = 0u;
    least_met = NO_MEASURE;
    least_tile = 0u;
#define CLEAR(i) shell[i] = NO_MEASURE;
    EACH_KEPT(CLEAR)
    bool accepts = searching;
    // Photons that tie are a crowd that no smaller reach gets rid of; of those at just the query's place enough will do.
    bool seeks_coincident = hi <= 0.0 && !my_search.counts_ties;
    bool may_give_up = !my_search.counts_ties &&
                       floatBitsToUint(max(hi, 0.0)) > floatBitsToUint(max(my_search.below, 0.0)) + 1u;
    uint crowd = seeks_coincident ? wanted - 1u : (may_give_up ? CROWD_FACTOR * wanted + CROWD_BASE : 0xffffffffu);
    is_cut_short = false;
    lane_reach = searching ? hi : -1.0;
    start_walk(leaf_level);
    bool goes_on = true;
    while (goes_on) {
        // Lanes that accept nothing more count nothing more.
        my_search.lo = accepts ? lo : -1.0;
        my_search.hi = accepts ? hi : -1.0;
        bool is_crowded = false;
        do {
            count_leaves(photon_count, leaf_level);
            walk_on();
            ++turns;
            is_crowded = accepts && my_search.hi_count > crowd;
            goes_on = !is_walk_over() && has_turns_left();
        } while (goes_on && !any_lane(is_crowded));
        is_cut_short = is_cut_short || (is_crowded && goes_on);
        accepts = accepts && !is_crowded;
        lane_reach = accepts ? hi : -1.0;
        goes_on = goes_on && any_lane(accepts);
    }
    my_search.lo = lo;
    my_search.hi = hi;
    if (!searching) my_search = kept;
}

// The shell's entry at a rank that counts from 1.
float pick_shell(uint rank) {
    uint picked = NO_MEASURE;
#define PICK(i) picked = uint(i) + 1u == rank ? shell[i] : picked;
    EACH_KEPT(PICK)
    return uintBitsToFloat(picked);
}

#ifdef CUT_TIES
const uint ALL_TIES = 0xffffffffu;

// Photons at just the radius are all members or none, or the query is left to others.
void settle_radius(float r2, uint rank, uint nearer, uint equal, bool is_short) {
    bool takes_all = is_short || (includes_last && nearer + equal == rank);
    bool takes_none = !is_short && !includes_last && nearer + 1u == rank;
    uint cut = takes_all ? ALL_TIES : 0u;
    my_radius = vec4(r2, uintBitsToFloat(cut), uintBitsToFloat(cut), float(rank));
    is_settled = takes_all || takes_none;
    my_search.searching = false;
}
#else
void settle_radius(float r2, uint rank, uint nearer, uint equal, bool is_short) {
    my_radius = share_ties(r2, rank, nearer, equal);
    is_settled = true;
    my_search.searching = false;
}
#endif

// Has the next pass count all that tie at a measure.
void count_ties(float measure, uint nearer) {
    my_search.counts_ties = true;
    my_search.nearer = nearer;
    my_search.lo = measure;
    my_search.hi = measure;
}

// Takes the radius from the shell if it is there. More photons than the shell holds may tie at it: then they are
// counted in another pass, with the radius itself as the bound.
void try_shell(uint rank, bool is_short) {
    float r2 = pick_shell(rank - my_search.lo_count);
    uint bits = floatBitsToUint(r2);
    uint nearer = my_search.lo_count, equal = 0u;
#define RANK_KEPT(i) nearer += uint(shell[i] < bits); equal += uint(shell[i] == bits);
    EACH_KEPT(RANK_KEPT)
    bool may_overflow = shell[SHELL_SIZE - 1u] == bits;
#ifdef CUT_TIES
    // Where the photon of the rank only gives the radius nothing need be known of those that tie with it.
    if (may_overflow && !includes_last && nearer + 1u < rank) equal = ALL_TIES / 2u;
    may_overflow = may_overflow && includes_last;
#endif
    if (may_overflow) count_ties(r2, nearer);
    else settle_radius(r2, rank, nearer, equal, is_short);
}

// What a pass that missed has taught.
void learn_counts(uint wanted) {
    if (my_search.lo_count >= wanted && my_search.lo < my_search.above) {
        my_search.above = my_search.lo;
        my_search.above_count = my_search.lo_count;
    }
    if (my_search.hi_count >= wanted && my_search.hi < my_search.above) {
        my_search.above = my_search.hi;
        my_search.above_count = my_search.hi_count;
    }
    if (is_cut_short) return;
    if (my_search.lo_count < wanted && my_search.lo >= my_search.below) {
        my_search.below = my_search.lo;
        my_search.below_count = my_search.lo_count;
    }
    if (my_search.hi_count < wanted) {
        my_search.below = my_search.hi;
        my_search.below_count = my_search.hi_count;
    } else if (my_search.lo_count + SHELL_SIZE < wanted) {
        // More lie below than the shell holds; of those that tie at its end only some may be in it.
        uint end = shell[SHELL_SIZE - 1u];
        uint nearer = my_search.lo_count;
#define COUNT_NEARER(i) nearer += uint(shell[i] < end);
        EACH_KEPT(COUNT_NEARER)
        my_search.below = uintBitsToFloat(max(end, 1u) - 1u);
        my_search.below_count = nearer;
    }
}

// Bounds about a radius that is expected there, if each photon takes up as much of the measure as told.
void aim_bounds(float target, float each) {
    float reach = each * float(SHELL_SIZE) * FIRST_FILL;
    my_search.lo = target - reach;
    my_search.hi = target + reach;
}

// The next bounds, from what is known. Counts grow with the measure beyond that of the nearest, on surfaces evenly.
void choose_bounds(uint wanted, uint pass, float limit) {
    float base = my_search.nearest < my_search.above ? my_search.nearest : max(my_search.below, 0.0);
    float below = max(my_search.below - base, 0.0);
    float above = my_search.above - base;
    bool is_open = my_search.above == INFINITY;
    if (is_open && 4u * my_search.below_count > wanted && pass < 2u) {
        float each = below / float(my_search.below_count);
        aim_bounds(base + each * (float(wanted) - 0.5), each);
    } else if (is_open) {
        float scale = 1.4 * float(wanted) / float(max(my_search.below_count, 1u));
        my_search.lo = my_search.below;
        my_search.hi = base + max(max(below * clamp(scale, 1.5, 16.0), limit * SMALLEST_SHARE), SMALLEST_MEASURE);
    } else if (is_cut_short && my_search.nearest <= 0.0 && my_search.below < 0.0) {
        my_search.lo = my_search.below; // the crowd may stand at just the query's place, as in discrete parameters
        my_search.hi = 0.0;
    } else if (is_cut_short) {
        my_search.lo = my_search.below;
        my_search.hi = base + (below > 0.0 ? sqrt(below) * sqrt(above) : above / 16.0);
    } else if (my_search.below_count + SHELL_SIZE >= wanted) { // the shell reaches it from here
        my_search.lo = my_search.below;
        my_search.hi = my_search.above;
    } else if (pass > PATIENCE) {
        uint middle = (floatBitsToUint(max(my_search.below, 0.0)) + floatBitsToUint(my_search.above)) / 2u;
        my_search.lo = uintBitsToFloat(middle);
        my_search.hi = my_search.above;
    } else {
        float each = (above - below) / float(my_search.above_count - my_search.below_count);
        float target = below + each * (float(wanted - my_search.below_count) - 0.5);
        if (my_search.below_count > 1u && below > 0.0) { // as a power of the measure
            float power = log2(float(my_search.above_count) / float(my_search.below_count)) / log2(above / below);
            target = below * exp2(log2((float(wanted) - 0.5) / float(my_search.below_count)) / power);
            each = target / (power * float(wanted));
        }
        // Where counts do not grow evenly the middle does better than what they point at.
        bool halves = pass > 2u && pass % 2u == 0u;
        aim_bounds(base + (halves ? 0.5 * (below + above) : target), each);
    }
    my_search.lo = clamp(my_search.lo, my_search.below, my_search.above);
    my_search.hi = min(max(my_search.hi, my_search.lo), min(my_search.above, limit));
}

// Looks at what a pass found, and takes the radius or prepares the next pass.
void judge_pass(inout uint rank, inout bool is_short, uint pass, float limit) {
    float least = uintBitsToFloat(least_met);
    bool is_new = my_search.hi_count > 0u && (!is_cut_short || least < my_search.nearest);
    my_search.nearest = is_new ? least : my_search.nearest;
    my_search.nearest_at = is_new ? least_tile : my_search.nearest_at;
    if (my_search.hi <= 0.0 && my_search.hi_count >= rank && !my_search.counts_ties) { // all at just its place
        settle_radius(0.0, rank, 0u, my_search.hi_count, is_short);
        return;
    }
    if (my_search.counts_ties) {
        my_search.counts_ties = false;
        if (my_search.lo_count >= rank) {
            settle_radius(my_search.lo, rank, my_search.nearer, my_search.lo_count - my_search.nearer, is_short);
        } else {
            my_search.below = my_search.lo;
            my_search.below_count = my_search.lo_count;
            choose_bounds(rank, pass, limit);
        }
        return;
    }
    if (!is_cut_short && my_search.hi >= limit && my_search.hi_count < rank) { // there are no more: the farthest's
        rank = my_search.hi_count;
        is_short = true;
        my_search.below = -1.0;
        my_search.below_count = 0u;
    }
    if (rank == 0u) { // nobody may be found
        my_radius = vec4(0.0);
        is_settled = true;
        my_search.searching = false;
        return;
    }
    bool reaches = !is_cut_short && my_search.lo_count < rank && rank <= my_search.lo_count + SHELL_SIZE &&
                   pick_shell(rank - my_search.lo_count) <= my_search.hi;
    // A shell of ties alone says nothing about what lies beyond.
    bool is_full_of_ties = !is_cut_short && my_search.lo_count + SHELL_SIZE < rank && shell[0] == shell[SHELL_SIZE - 1u] &&
                           uintBitsToFloat(shell[0]) <= my_search.hi;
    if (reaches) {
        try_shell(rank, is_short);
    } else if (is_full_of_ties) {
        count_ties(uintBitsToFloat(shell[0]), my_search.lo_count);
    } else {
        learn_counts(rank);
        // Between 0, or a float, and its neighbor there is nothing: the radius is known.
        bool is_pinned = my_search.below < 0.0 ? my_search.above <= 0.0 : my_search.above < INFINITY &&
                         floatBitsToUint(my_search.above) <= floatBitsToUint(my_search.below) + 1u;
        if (is_pinned) count_ties(my_search.above, my_search.below < 0.0 ? 0u : my_search.below_count);
        else choose_bounds(rank, pass, limit);
    }
}

// Finds the radius of every lane's query for a rank that counts from 1. `guess2` is a squared radius that may be right,
// `nearest2` about that of the nearest candidate.
void find_radius(bool has_query, GatherSettings gather, float guess2, float nearest2) {
    uint wanted = gather.rank;
    float limit = limit_reach();
    float share = FIRST_FILL * float(SHELL_SIZE) / float(wanted);
    // A shell that holds all needs no bound below.
    float each2 = guess2 - nearest2;
    float lo = wanted <= SHELL_SIZE ? -1.0 : guess2 - each2 * share;
    float hi = min(guess2 + each2 * (wanted <= SHELL_SIZE ? 1.2 : clamp(share, 0.1, 0.4)), limit);
    my_search = Search(has_query, min(lo, hi), hi, -1.0, INFINITY, 0u, 0u, 0u, 0u, false, 0u, nearest2, 0u);
    my_radius = vec4(0.0);
    is_settled = false;
    map_size = gather.photon_count;
    includes_last = gather.includes_last != 0u;
    uint rank = wanted; // fewer photons than wanted: the farthest's
    bool is_short = false;
    uint pass = 0u; // of this lane
    bool goes_on = has_turns_left();
    while (any_lane(my_search.searching && pass < LARGEST_PASS_COUNT) && goes_on) {
        bool takes_part = my_search.searching && pass < LARGEST_PASS_COUNT;
        count_pass(takes_part, wanted, gather.photon_count, gather.leaf_level);
        goes_on = has_turns_left();
        if (takes_part && goes_on) judge_pass(rank, is_short, pass, limit);
        pass += uint(takes_part);
        ++turns;
    }
}
