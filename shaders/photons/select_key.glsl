// SPDX-License-Identifier: Apache-2.0
// Finds the key of a rank among the photons of a node, with one subgroup, and moves photons to its two sides.
// Needs photons/tree_source.glsl. Scratch: candidates (key, place), a photon's worth each.
#pragma binding coherent uvec2 candidates

#define WIDTH gl_WorkGroupSize.x
#define LANE gl_LocalInvocationID.x

// In order of values, then of places in `source`, which within a node are in order of photon ids.
struct Key {
    int value;
    uint place;
};

const Key LEAST = Key(LEAST_KEY, 0u);
const Key GREATEST = Key(GREATEST_KEY, 0xffffffffu);

bool is_less(Key a, Key b) { return a.value < b.value || (a.value == b.value && a.place < b.place); }

void synchronize() {
    subgroupMemoryBarrierBuffer();
    subgroupBarrier();
}

// Keys a lane holds when samples are ranked.
const uint HELD = 4u;
// How far from the rank sought, in samples of 4·8, the two sampled keys are: 1.8 deviations of a random sample.
const float MARGIN = 5.0 / 32.0;

Key held[HELD];
uint ranks[HELD];

void rank_held() {
    for (uint i = 0u; i < HELD; ++i) ranks[i] = 0u;
    for (uint lane = 0u; lane < WIDTH; ++lane)
        for (uint i = 0u; i < HELD; ++i) {
            Key other = Key(subgroupBroadcast(held[i].value, lane), subgroupBroadcast(held[i].place, lane));
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
    uint lane = subgroupBallotFindLSB(subgroupBallot(is_mine));
    return Key(subgroupBroadcast(found.value, lane), subgroupBroadcast(found.place, lane));
}

// Place s of `parts` evenly spaced ones among n, without overflow; parts are a power of two, n is no less.
uint find_spaced(uint n, uint s, uint parts) { return n / parts * s + n % parts * s / parts + n / (2u * parts); }

// Two of the held samples about the wanted share of all keys.
void choose_bracket(float share, out Key lo, out Key hi) {
    rank_held();
    float samples = float(HELD * WIDTH);
    int below = int(floor((share - MARGIN) * samples));
    int above = int(ceil((share + MARGIN) * samples));
    lo = LEAST;
    hi = GREATEST;
    Key low = find_held(uint(max(below, 0)));
    Key high = find_held(uint(min(above, int(HELD * WIDTH) - 1)));
    if (below >= 0) lo = low;
    if (above < int(HELD * WIDTH)) hi = high;
}

Key read_source(uint place, uint axis) { return Key(find_key(source_at(place), axis), place); }

Key read_candidate(uint i) {
    uvec2 candidate = candidates[i];
    return Key(int(candidate.x), candidate.y);
}

void keep(Key key, bool is_kept, uint first, inout uint kept) {
    uvec4 ballot = subgroupBallot(is_kept);
    if (is_kept) candidates[first + kept + subgroupBallotExclusiveBitCount(ballot)] = uvec2(uint(key.value), key.place);
    kept += subgroupBallotBitCount(ballot);
}

// Sets aside the keys of the source from lo up to hi; returns how many are below.
uint keep_source(uint first, uint end, uint axis, Key lo, Key hi, out uint kept) {
    uint below = 0u;
    kept = 0u;
    for (uint i = first; i < end; i += WIDTH) {
        Key key = read_source(min(i + LANE, end - 1u), axis);
        bool is_valid = i + LANE < end;
        bool is_low = is_less(key, lo);
        below += uint(is_valid && is_low);
        keep(key, is_valid && !is_low && is_less(key, hi), first, kept);
    }
    synchronize();
    return subgroupAdd(below);
}

uint count_below(uint first, uint end, Key limit) {
    uint below = 0u;
    for (uint i = first + LANE; i < end; i += WIDTH) below += uint(is_less(read_candidate(i), limit));
    return subgroupAdd(below);
}

// Of the candidates keeps those from lo up to hi, in place.
uint keep_candidates(uint first, uint end, Key lo, Key hi) {
    uint kept = 0u;
    for (uint i = first; i < end; i += WIDTH) {
        Key key = read_candidate(min(i + LANE, end - 1u));
        synchronize();
        keep(key, i + LANE < end && !is_less(key, lo) && is_less(key, hi), first, kept);
        synchronize();
    }
    return kept;
}

// Moves a bracket that missed the rank to the side where it is. Returns whether it had missed.
bool mend_bracket(uint rank, uint below, uint kept, inout Key lo, inout Key hi) {
    bool is_before = rank < below, is_behind = rank >= below + kept;
    Key old = lo;
    if (is_behind) lo = hi;
    if (is_behind) hi = GREATEST;
    if (is_before) lo = LEAST;
    if (is_before) hi = old;
    return is_before || is_behind;
}

// The key of that rank among `count` candidates.
Key select_candidate(uint first, uint count, uint rank) {
    while (count > HELD * WIDTH) {
        for (uint i = 0u; i < HELD; ++i)
            held[i] = read_candidate(first + find_spaced(count, i * WIDTH + LANE, HELD * WIDTH));
        Key lo, hi;
        choose_bracket((float(rank) + 0.5) / float(count), lo, hi);
        uint below = count_below(first, first + count, lo);
        uint kept = count_below(first, first + count, hi) - below;
        if (mend_bracket(rank, below, kept, lo, hi)) below = count_below(first, first + count, lo);
        count = keep_candidates(first, first + count, lo, hi);
        rank -= below;
    }
    for (uint i = 0u; i < HELD; ++i) {
        uint at = i * WIDTH + LANE;
        held[i] = read_candidate(first + min(at, count - 1u));
        if (at >= count) held[i] = GREATEST;
    }
    rank_held();
    return find_held(rank);
}

// The key of that rank among the photons first … end - 1 of the source.
Key find_median(uint first, uint end, uint rank, uint axis) {
    Key lo = LEAST, hi = GREATEST;
    uint n = end - first;
    if (n > HELD * WIDTH) {
        for (uint i = 0u; i < HELD; ++i)
            held[i] = read_source(first + find_spaced(n, i * WIDTH + LANE, HELD * WIDTH), axis);
        choose_bracket((float(rank) + 0.5) / float(n), lo, hi);
    }
    uint kept;
    uint below = keep_source(first, end, axis, lo, hi, kept);
    if (mend_bracket(rank, below, kept, lo, hi)) below = keep_source(first, end, axis, lo, hi, kept);
    return select_candidate(first, kept, rank - below);
}

// Writes the photons below the pivot from `left` on, the others from `right` on.
void move_photons(uint first, uint end, uint axis, Key pivot, inout uint left, inout uint right, inout Halves halves) {
    for (uint i = first; i < end; i += WIDTH) {
        uint place = min(i + LANE, end - 1u);
        vec4 photon = source_at(place);
        bool is_below = is_less(Key(find_key(photon, axis), place), pivot);
        bool is_valid = i + LANE < end;
        uvec4 lefts = subgroupBallot(is_valid && is_below);
        uvec4 rights = subgroupBallot(is_valid && !is_below);
        uint to = is_below ? left + subgroupBallotExclusiveBitCount(lefts)
                           : right + subgroupBallotExclusiveBitCount(rights);
        if (is_valid) target[to] = photon;
        left += subgroupBallotBitCount(lefts);
        right += subgroupBallotBitCount(rights);
        widen(halves.left_lo, halves.left_hi, photon.xyz, is_below); // the last photon may come again
        widen(halves.right_lo, halves.right_hi, photon.xyz, !is_below);
    }
}

vec3 join_least(vec3 v) { return vec3(subgroupMin(v.x), subgroupMin(v.y), subgroupMin(v.z)); }
vec3 join_greatest(vec3 v) { return vec3(subgroupMax(v.x), subgroupMax(v.y), subgroupMax(v.z)); }

Halves join_halves(Halves halves) {
    return Halves(join_least(halves.left_lo), join_greatest(halves.left_hi), join_least(halves.right_lo),
                  join_greatest(halves.right_hi));
}

#ifdef RANGE_ROWS
const uint SPREAD_SAMPLES = 64u;

Spread join_spread(Spread spread) {
    spread.count = subgroupAdd(spread.count);
    for (uint i = 0u; i < 3u; ++i) {
        spread.sum[i] = subgroupAdd(spread.sum[i]);
        spread.squares[i] = subgroupAdd(spread.squares[i]);
    }
    for (uint row = 0u; row < RANGE_ROWS; ++row) {
        spread.row_sums[row] = subgroupAdd(spread.row_sums[row]);
        spread.row_squares[row] = subgroupAdd(spread.row_squares[row]);
    }
    return spread;
}

// The axis of greatest spread among evenly spaced photons of the n at `first`; among all where those are alike.
uint choose_sampled_axis(uint first, uint n) {
    vec4 base = source_at(first);
    Spread spread = start_spread();
    for (uint s = LANE; s < SPREAD_SAMPLES; s += WIDTH)
        add_photon(spread, source_at(first + find_spaced(n, s, SPREAD_SAMPLES)), base, true);
    float greatest;
    uint axis = choose_axis(join_spread(spread), greatest);
    uint rest = greatest > 0.0 ? 0u : n;
    vec3 lo = vec3(0.0), hi = vec3(0.0);
    vec4 row_lo[RANGE_ROWS], row_hi[RANGE_ROWS];
    for (uint row = 0u; row < RANGE_ROWS; ++row) row_lo[row] = row_hi[row] = vec4(0.0);
    for (uint i = LANE; i < rest; i += WIDTH) {
        vec4 photon = source_at(first + i);
        lo = min(lo, photon.xyz - base.xyz);
        hi = max(hi, photon.xyz - base.xyz);
        for (uint row = 0u; row < RANGE_ROWS; ++row) {
            vec4 difference = read_row(photon, row) - read_row(base, row);
            row_lo[row] = min(row_lo[row], difference);
            row_hi[row] = max(row_hi[row], difference);
        }
    }
    vec3 extent = (join_greatest(hi) - join_least(lo)) * scales[0].xyz;
    prefer(extent.x, 0u, greatest, axis);
    prefer(extent.y, 1u, greatest, axis);
    prefer(extent.z, 2u, greatest, axis);
    for (uint row = 0u; row < RANGE_ROWS; ++row)
        for (uint i = 0u; i < 4u; ++i) {
            float scaled = (subgroupMax(row_hi[row][i]) - subgroupMin(row_lo[row][i])) * scales[1u + row][i];
            prefer(scaled, 3u + 4u * row + i, greatest, axis);
        }
    return axis;
}
#endif

uint choose_axis_of(uint heap, uint first, uint n) {
#ifdef RANGE_ROWS
    return choose_sampled_axis(first, n);
#else
    return find_widest(tree_nodes[heap].hi_axis.xyz - tree_nodes[heap].lo_split.xyz);
#endif
}
