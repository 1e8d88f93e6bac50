// SPDX-License-Identifier: Apache-2.0
// Candidates that lanes flag while tiles stream by, kept as words of flags: a store for each candidate would cost more
// than looking at it. The kernel includes photons/visit_tiles.glsl first and defines
// void take_flagged(bool has, uint position), called with one flagged candidate a lane until there are no more.

// Candidates whose flags share a word.
#define SPAN min(WIDTH, 16u)
const uint SPANS_PER_LEAF = 4u; // of TREE_LEAF_PHOTONS, narrowest subgroups of 8
const uint SPAN_SHIFT = 16u;

shared uint span_first[LEAF_LIST_SIZE * SPANS_PER_LEAF];                      // tree position of a span
shared uint flag_words[LEAF_LIST_SIZE * SPANS_PER_LEAF * gl_WorkGroupSize.x]; // flags | span << SPAN_SHIFT

uint my_span;       // spans streamed
uint my_word_count; // of this lane, with a flag

void take_flagged(bool has, uint position);

void begin_flags() {
    my_span = 0u;
    my_word_count = 0u;
}

// Keeps a lane's flags of the span that begins at tree position `first`.
void store_flags(uint flags, uint first) {
    if (LANE == 0u) span_first[my_span] = first;
    flag_words[my_word_count * WIDTH + LANE] = flags | my_span << SPAN_SHIFT;
    my_word_count += uint(flags != 0u);
    ++my_span;
}

void visit_flagged() {
    uint slot = 0u;
    uint word = flag_words[LANE];
    uint flags = my_word_count > 0u ? word & 0xffffu : 0u;
    bool goes_on = subgroupAny(flags != 0u);
    while (goes_on) {
        ++turns;
        bool has = flags != 0u;
        // Words nobody wrote name no span.
        uint position = has ? span_first[word >> SPAN_SHIFT] + uint(findLSB(has ? flags : 1u)) : 0u;
        take_flagged(has, position);
        flags &= flags - 1u;
        if (flags == 0u) {
            ++slot;
            bool more = slot < my_word_count;
            word = flag_words[(more ? slot : 0u) * WIDTH + LANE];
            flags = more ? word & 0xffffu : 0u;
        }
        goes_on = subgroupAny(flags != 0u);
    }
}
