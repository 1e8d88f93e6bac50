// SPDX-License-Identifier: Apache-2.0
// The k smallest photons by a measure for a subgroup of queries, one a lane. The lanes walk the tree together and
// stream the photons of every leaf that any of them reaches; each keeps those within its radius, and when a lane's
// list is full all lists are sorted by a network in registers and cut to k, which shrinks the radii.
// Loops are flat and end with their condition, and rare work stands outside the hot ones: on SIMD without branches
// every statement in a loop is paid for by every turn.
// The kernel defines Query, Candidate, load_candidate, share_candidate, measure_candidate (never below the squared
// distance; INFINITY: not wanted) and measure_limit. Defines: CAPACITY (a power of two above k by a subgroup's width),
// SORT_BLOCK (keys sorted at once), SORT_NETWORK (its comparators EXCHANGE(i, j)), LOAD_KEYS, STORE_KEYS.
// Inputs: tree_nodes (2 texels a node), tree_positions (xyz, w photon id). Scratch: candidates, ranked.
#pragma binding coherent uint candidates
#pragma binding coherent uint ranked

// Enough for a typical query's photons; more would be streamed before the first cut could tell that they are too far.
#define LEAF_LIST_SIZE 40u
#include "photons/place.glsl"
#include "photons/walk_tree.glsl"
// A search that kept fewer than k tries a radius with this much more area than its count asks for.
const float GUESS_SLACK = 1.4;

shared uint keys[CAPACITY * gl_WorkGroupSize.x];

// One lane's search.
struct Search {
    bool searching;  // the radius tried may still hold fewer than k
    float radius2;   // squared radius tried
    float reach;     // photons beyond this measure are of no use; negative: none is wanted any more
    uint count;      // photons kept
};

Query my_query;
Search my_search;

uint locate_candidate(uint index) { return (gl_WorkGroupID.x * CAPACITY + index) * WIDTH + LANE; }

// Squared distance from a node's box to the nearest query that reaches it; INFINITY when none does.
float measure_node(uint node) {
    vec3 lo = tree_nodes_at(2u * node).xyz;
    vec3 hi = tree_nodes_at(2u * node + 1u).xyz;
    float nearest = INFINITY;
    for (uint base = 0u; base < WIDTH; base += 8u) {
#define REACH(j) { vec3 point = vec3(subgroupBroadcast(my_query.point.x, base + j), \
            subgroupBroadcast(my_query.point.y, base + j), subgroupBroadcast(my_query.point.z, base + j)); \
        float distance = measure_box_gap(point, point, lo, hi) * BOX_ROUNDING; \
        nearest = distance <= subgroupBroadcast(my_search.reach, base + j) ? min(nearest, distance) : nearest; }
        REACH(0u) REACH(1u) REACH(2u) REACH(3u) REACH(4u) REACH(5u) REACH(6u) REACH(7u)
    }
    return nearest;
}

// The part of the leaf list that has not been streamed.
struct Stream {
    uint leaf; // index in the list
    uint next; // photon
    uint end;
};

void enter_leaf(inout Stream stream, uint leaf_count, uint photon_count, uint leaf_level) {
    uint j = leaf_list[min(stream.leaf, leaf_count - 1u)] - (1u << leaf_level);
    stream.next = find_first_position(photon_count, j, leaf_level);
    stream.end = find_first_position(photon_count, j + 1u, leaf_level);
}

// Streams leaves until the list is through or a lane's list is full.
void stream_leaves(inout Stream stream, uint leaf_count, uint photon_count, uint leaf_level) {
    bool goes_on = stream.leaf < leaf_count;
    while (goes_on) {
        turns += 2u + WIDTH / 8u;
        Candidate mine = load_candidate(min(stream.next + LANE, stream.end - 1u));
        for (uint lane = 0u; lane < WIDTH; lane += 8u) {
#define STREAM(c) { float measure = measure_candidate(my_query, share_candidate(mine, lane + c)); \
            bool within = measure <= my_search.reach && stream.next + lane + c < stream.end; \
            if (within) candidates[locate_candidate(my_search.count)] = stream.next + lane + c; \
            my_search.count += uint(within); }
            STREAM(0u) STREAM(1u) STREAM(2u) STREAM(3u) STREAM(4u) STREAM(5u) STREAM(6u) STREAM(7u)
        }
        stream.next += WIDTH;
        bool is_through = stream.next >= stream.end;
        stream.leaf += uint(is_through);
        if (is_through) enter_leaf(stream, leaf_count, photon_count, leaf_level);
        goes_on = stream.leaf < leaf_count && subgroupMax(my_search.count) + WIDTH <= CAPACITY;
    }
}

#define EXCHANGE(i, j) { uint low = min(key[i], key[j]); key[j] = max(key[i], key[j]); key[i] = low; }

const uint BLOCK_COUNT = CAPACITY / SORT_BLOCK;
const uint NO_KEY = 0xffffffffu;

uint locate_key(uint index) { return index * WIDTH + LANE; }

// Sorts one block of keys by a network on registers.
void sort_block(uint block) {
    uint key[SORT_BLOCK];
    LOAD_KEYS
    SORT_NETWORK
    STORE_KEYS
}

// Merges the sorted blocks into the ranked half of the scratch.
void merge_blocks(uint most) {
    uint head[BLOCK_COUNT];
    uint taken[BLOCK_COUNT];
    for (uint b = 0u; b < BLOCK_COUNT; ++b) {
        head[b] = keys[locate_key(b * SORT_BLOCK)];
        taken[b] = 0u;
    }
    for (uint rank = 0u; rank < most; ++rank) {
        uint best = head[0];
        for (uint b = 1u; b < BLOCK_COUNT; ++b) best = min(best, head[b]);
        ranked[locate_candidate(rank)] = candidates[locate_candidate(best & (CAPACITY - 1u))];
        uint next = 0u;
        bool is_last = false;
        for (uint b = 0u; b < BLOCK_COUNT; ++b) {
            taken[b] += uint(head[b] == best);
            next = head[b] == best ? b * SORT_BLOCK + min(taken[b], SORT_BLOCK - 1u) : next;
            is_last = head[b] == best ? taken[b] == SORT_BLOCK : is_last;
        }
        uint loaded = is_last ? NO_KEY : keys[locate_key(next)];
        for (uint b = 0u; b < BLOCK_COUNT; ++b) head[b] = head[b] == best ? loaded : head[b];
    }
}

// Orders the kept photons by key: the measure's upper bits and the place among the candidates.
void sort_candidates() {
    uint most = subgroupMax(my_search.count);
    turns += CAPACITY + most + BLOCK_COUNT + 4u;
    for (uint i = 0u; i < most; ++i) {
        bool valid = i < my_search.count;
        float measure = measure_candidate(my_query, load_candidate(candidates[locate_candidate(valid ? i : 0u)]));
        keys[locate_key(i)] = valid ? (floatBitsToUint(measure) & ~(CAPACITY - 1u)) | i : NO_KEY;
    }
    for (uint i = most; i < CAPACITY; ++i) keys[locate_key(i)] = NO_KEY;
    for (uint block = 0u; block < BLOCK_COUNT; ++block) sort_block(block);
    merge_blocks(most);
}

// Photons whose keys share their upper bits may stand in the wrong order: neighbors are compared exactly until none is.
void settle_order() {
    bool settled = false;
    uint most = subgroupMax(my_search.count);
    do {
        settled = true;
        turns += most + 1u;
        Candidate before = load_candidate(ranked[locate_candidate(0u)]);
        float before_measure = measure_candidate(my_query, before);
        for (uint rank = 1u; rank < most; ++rank) {
            uint position = ranked[locate_candidate(rank)];
            Candidate after = load_candidate(position);
            float after_measure = measure_candidate(my_query, after);
            bool valid = rank < my_search.count;
            bool wrong = valid && (after_measure < before_measure ||
                                   (after_measure == before_measure && after.id < before.id));
            if (wrong) {
                ranked[locate_candidate(rank)] = ranked[locate_candidate(rank - 1u)];
                ranked[locate_candidate(rank - 1u)] = position;
                settled = false;
            }
            if (valid && !wrong) {
                before = after;
                before_measure = after_measure;
            }
        }
    } while (!subgroupAll(settled) && has_turns_left());
}

// Sorts every list, cuts it to k and shrinks the lane's reach to its last photon.
void cut_lists(uint k) {
    sort_candidates();
    settle_order();
    my_search.count = min(my_search.count, k);
    uint most = subgroupMax(my_search.count);
    turns += most + 2u;
    for (uint rank = 0u; rank < most; ++rank)
        if (rank < my_search.count) candidates[locate_candidate(rank)] = ranked[locate_candidate(rank)];
    if (my_search.searching && my_search.count == k)
        my_search.reach = measure_candidate(my_query, load_candidate(candidates[locate_candidate(k - 1u)]));
}

// One pass over the tree with the reach of the lanes still searching.
void search_tree(uint photon_count, uint leaf_level, uint k) {
    uint depth = leaf_level == 0u ? 0u : 1u;
    uint leaf_count = leaf_level == 0u ? 1u : 0u;
    Stream stream = Stream(0u, 0u, 0u);
    start_walk();
    do {
        if (stream.leaf >= leaf_count) { // all streamed: the list starts over
            stream.leaf = 0u;
            leaf_count = leaf_level == 0u && depth == 0u && stream.end == 0u ? 1u : 0u;
        }
        bool walks = leaf_count == 0u;
        uint walk_depth = walks ? depth : 0u;
        walk_tree(leaf_level, walk_depth, leaf_count);
        depth = walks ? walk_depth : depth;
        if (walks || stream.end == 0u) enter_leaf(stream, max(leaf_count, 1u), photon_count, leaf_level);
        stream_leaves(stream, leaf_count, photon_count, leaf_level);
        cut_lists(k);
        ++turns;
    } while ((depth > 0u || stream.leaf < leaf_count) && has_turns_left());
}

// Widens the radius of lanes that kept fewer than k, unless it holds all photons; the others are done.
void widen_radius(uint k, float largest2) {
    my_search.searching = my_search.searching && my_search.count < k && my_search.radius2 < largest2;
    // Photons lie on surfaces: the count grows with the squared radius.
    float scale = GUESS_SLACK * float(k) / float(max(my_search.count, 1u));
    if (my_search.searching) {
        my_search.radius2 = min(my_search.radius2 * clamp(scale, 1.2, 16.0), largest2);
        my_search.count = 0u;
    }
    my_search.reach = my_search.searching ? my_search.radius2 : -1.0;
}

// Finds the k smallest for every lane; `guess2` is the squared radius to try first. Leaves my_search.count of them,
// in order, in find_photon(0 …). Without turns left at the end the result is not to be trusted.
void find_smallest(bool has_query, uint photon_count, uint leaf_level, uint k, float guess2) {
    vec3 lo = tree_nodes_at(2u).xyz;
    vec3 hi = tree_nodes_at(3u).xyz;
    vec3 span = max(abs(my_query.point - lo), abs(hi - my_query.point));
    float largest2 = measure_limit(my_query, dot(span, span)) * 1.0001;
    float radius2 = min(guess2, largest2);
    my_search = Search(has_query, radius2, has_query ? radius2 : -1.0, 0u);
    do {
        search_tree(photon_count, leaf_level, k);
        widen_radius(k, largest2);
        ++turns;
    } while (subgroupAny(my_search.searching) && has_turns_left());
}

// Tree position of the photon of that rank.
uint find_photon(uint rank) { return candidates[locate_candidate(rank)]; }
