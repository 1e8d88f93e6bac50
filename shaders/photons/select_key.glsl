// SPDX-License-Identifier: Apache-2.0
// Finds the key of a rank among photons, with one subgroup, and moves photons to its two sides. Keys are counted
// against several pivots at once until few are left; nothing is stored meanwhile, as a store costs several such passes.
// Needs photons/tree_source.glsl. Define: LISTED where the photons are those whose places stand in `candidates`.
#pragma binding coherent uint candidates

#define WIDTH gl_WorkGroupSize.x
#define LANE gl_LocalInvocationID.x

// In order of values, then of places in `source`, which within a node are in order of photon ids.
struct Key {
    int value;
    int place; // signed: so compared in one instruction
};

const Key LEAST = Key(LEAST_KEY, 0);
const Key GREATEST = Key(GREATEST_KEY, 0x7fffffff);

bool is_less(Key a, Key b) { return a.value < b.value || (a.value == b.value && a.place < b.place); }

Key read_source(uint place, uint axis) { return Key(find_key(source_at(place), axis), int(place)); }

#ifdef LISTED
Key read_item(uint i, uint axis) { return read_source(candidates[i], axis); }
#else
Key read_item(uint i, uint axis) { return read_source(i, axis); }
#endif

// Place s of `parts` evenly spaced ones among n, without overflow; parts are a power of two, n is no less.
uint find_spaced(uint n, uint s, uint parts) { return n / parts * s + n % parts * s / parts + n / (2u * parts); }

// Keys a lane holds when they are ranked.
const uint HELD = 4u;
Key held[HELD];
uint ranks[HELD];

void rank_held() {
    for (uint i = 0u; i < HELD; ++i) ranks[i] = 0u;
    for (uint lane = 0u; lane < WIDTH; ++lane)
        for (uint i = 0u; i < HELD; ++i) {
            Key other = Key(broadcast(held[i].value, lane), broadcast(held[i].place, lane));
            for (uint j = 0u; j < HELD; ++j) ranks[j] += uint(is_less(other, held[j]));
        }
}

Key find_held(uint rank) {
    Key found = GREATEST;
    bool is_mine = false;
    for (uint i = 0u; i < HELD; ++i)
        if (ranks[i] == rank) {
            found = held[i];
            is_mine = true;
        }
    uint lane = find_first_lane(find_lanes(is_mine));
    return Key(broadcast(found.value, lane), broadcast(found.place, lane));
}

// Items first … end - 1, along an axis, whose places are from place_first up to place_end; the key of `rank` is sought.
struct Search {
    uint first, end;
    uint axis, rank;
    int place_first, place_end;
};

// The key sought is in [lo, hi); keys before lo, and before hi.
struct Range {
    Key lo, hi;
    uint below, behind;
};

const uint PIVOTS = 6u;
int pivots[PIVOTS]; // values; where few values are left, places of photons with the value of `lo`
bool are_places;
uint counts[PIVOTS];

// Of 32 sampled keys, those so far from the rank sought: few deviations of a random sample. The greater ones bound their
// value from above, so that a value many photons have is found at once.
const float SAMPLE_OFFSETS[PIVOTS] = float[](-6.0, -2.5, -0.7, 0.7, 2.5, 6.0);
// Between two keys: evenly, so that the distance between them shrinks for certain, and about where the one sought is
// when keys are evenly dense.
const float EVEN_SHARES[PIVOTS / 2u] = float[](0.25, 0.5, 0.75);
const float NEAR_OFFSETS[PIVOTS / 2u] = float[](-0.08, 0.0, 0.08);

void sample_pivots(Search search) {
    uint n = search.end - search.first;
    for (uint i = 0u; i < HELD; ++i)
        held[i] = read_item(search.first + find_spaced(n, i * WIDTH + LANE, HELD * WIDTH), search.axis);
    rank_held();
    float scale = float(HELD * WIDTH);
    float wanted = (float(search.rank) + 0.5) / float(n) * scale;
    for (uint i = 0u; i < PIVOTS; ++i) {
        float rank = clamp(wanted + SAMPLE_OFFSETS[i] * scale / 32.0, 0.0, scale - 1.0);
        pivots[i] = find_held(uint(rank)).value + int(i >= PIVOTS / 2u);
    }
    are_places = false;
}

float get_share(uint i, float expected) {
    return i < PIVOTS / 2u ? EVEN_SHARES[i] : expected + NEAR_OFFSETS[i - PIVOTS / 2u];
}

uint interpolate(uint span, float share) { return clamp(uint(float(span) * clamp(share, 0.0, 1.0)), 1u, span - 1u); }

// Between the values of the range's ends; of places where there is no value between.
void interpolate_pivots(Search search, Range range) {
    float expected = (float(search.rank - range.below) + 0.5) / float(range.behind - range.below);
    uint span = uint(range.hi.value) - uint(range.lo.value);
    int place = max(range.lo.place, search.place_first);
    uint places = uint((span == 0u ? min(range.hi.place, search.place_end) : search.place_end) - place);
    are_places = span < 2u;
    for (uint i = 0u; i < PIVOTS; ++i) {
        float share = get_share(i, expected);
        if (are_places) pivots[i] = place + (places < 2u ? 1 : int(interpolate(places, share)));
        else pivots[i] = int(uint(range.lo.value) + interpolate(span, share));
    }
    if (span == 1u) pivots[0] = GREATEST_KEY; // behind all with the value of lo
}

// What is compared with the pivots.
int project(Key key, int value) {
    int place = key.value < value ? LEAST_KEY : (key.value > value ? GREATEST_KEY : key.place);
    return are_places ? place : key.value;
}

Key get_pivot(uint i, Range range) {
    if (!are_places) return Key(pivots[i], 0);
    return pivots[i] == GREATEST_KEY ? Key(range.hi.value, 0) : Key(range.lo.value, pivots[i]);
}

void count_below_pivots(Search search, Range range) {
    for (uint i = 0u; i < PIVOTS; ++i) counts[i] = 0u;
    for (uint item = search.first + LANE; item < search.end; item += WIDTH) {
        int key = project(read_item(item, search.axis), range.lo.value);
        for (uint i = 0u; i < PIVOTS; ++i) counts[i] += uint(key < pivots[i]);
    }
    for (uint i = 0u; i < PIVOTS; ++i) counts[i] = sum_lanes(counts[i]);
}

void narrow_range(uint rank, inout Range range) {
    Range old = range;
    for (uint i = 0u; i < PIVOTS; ++i) {
        Key pivot = get_pivot(i, old);
        bool is_lo = counts[i] <= rank && is_less(range.lo, pivot);
        bool is_hi = counts[i] > rank && is_less(pivot, range.hi);
        if (is_lo) range.lo = pivot;
        if (is_lo) range.below = counts[i];
        if (is_hi) range.hi = pivot;
        if (is_hi) range.behind = counts[i];
    }
}

// Holds the keys within the range; false if a lane met too many.
bool hold_range(Search search, Range range) {
    uint n = 0u;
    for (uint i = 0u; i < HELD; ++i) held[i] = GREATEST;
    for (uint item = search.first + LANE; item < search.end; item += WIDTH) {
        Key key = read_item(item, search.axis);
        bool is_within = !is_less(key, range.lo) && is_less(key, range.hi);
        for (uint i = 0u; i < HELD; ++i)
            if (is_within && n == i) held[i] = key;
        n += uint(is_within);
    }
    return !any_lane(n > HELD);
}

// The key sought; GREATEST if it takes more than that many passes over the items.
Key find_ranked(Search search, uint most_passes) {
    Range range = Range(LEAST, GREATEST, 0u, search.end - search.first);
    uint few = HELD * WIDTH * 3u / 4u;
    uint passes = 0u;
    bool is_held = false;
    if (range.behind > HELD * WIDTH) {
        sample_pivots(search);
        count_below_pivots(search, range);
        narrow_range(search.rank, range);
    }
    while (!is_held && passes < most_passes) {
        ++passes;
        bool is_few = range.behind - range.below <= few;
        if (is_few) {
            is_held = hold_range(search, range);
            few = HELD;
        } else {
            interpolate_pivots(search, range);
            count_below_pivots(search, range);
            narrow_range(search.rank, range);
        }
    }
    rank_held();
    return is_held ? find_held(search.rank - range.below) : GREATEST;
}

// Writes the photons below the pivot from `left` on, the others from `right` on.
void move_photons(uint first, uint end, uint axis, Key pivot, inout uint left, inout uint right, inout Halves halves) {
    for (uint i = first; i < end; i += WIDTH) {
        uint place = min(i + LANE, end - 1u);
        vec4 photon = source_at(place);
        bool is_below = is_less(Key(find_key(photon, axis), int(place)), pivot);
        bool is_valid = i + LANE < end;
        uvec2 ballot = find_lanes(is_valid && is_below);
        uint lefts = count_before(ballot);
        if (is_valid) target[is_below ? left + lefts : right + LANE - lefts] = photon;
        lefts = count_lanes(ballot);
        left += lefts;
        right += min(WIDTH, end - i) - lefts;
        widen(halves.left_lo, halves.left_hi, photon.xyz, is_below); // the last photon may come again
        widen(halves.right_lo, halves.right_hi, photon.xyz, !is_below);
    }
}

vec3 join_least(vec3 v) { return vec3(find_least(v.x), find_least(v.y), find_least(v.z)); }
vec3 join_greatest(vec3 v) { return vec3(find_most(v.x), find_most(v.y), find_most(v.z)); }

Halves join_halves(Halves halves) {
    return Halves(join_least(halves.left_lo), join_greatest(halves.left_hi), join_least(halves.right_lo),
                  join_greatest(halves.right_hi));
}
