// SPDX-License-Identifier: Apache-2.0
// What the passes of scripts and the host exchange.
#ifndef PHOTONLOUPE_SHARED_SCRIPT_H
#define PHOTONLOUPE_SHARED_SCRIPT_H

#include "shared/types.h"

SHARED_BEGIN

// One dispatch runs block_count × groups workgroups of SCRIPT_LANES. Workgroup w takes block
// first_block + w % block_count; its lane l takes photons block · SCRIPT_BLOCK + round · SCRIPT_LANES + l in turn, for
// `rounds` rounds from first_round + (w / block_count) · rounds on. A pass that reduces is dispatched with one group: a
// lane's photons in order.
const uint SCRIPT_BLOCK = 4096u;
const uint SCRIPT_LANES = 64u;
const uint SCRIPT_ROUNDS = 64u; // of a block

struct ScriptPass {
    uint first_block;
    uint block_count;
    uint first_round;
    uint rounds;
    uint photon_count;
    uint seed;
    uint fuel;            // turns of unbounded loops a photon has
    uint flags;
    uint parameter_count; // declared
    uint lane_block;      // the block that lane_words begins with
    uint zero;            // 0, which compilers do not know
    uint pad0;
    vec4 origin;          // xyz: world position of the columns' (0, 0, 0)
};

// Flags: nothing is written but status_words; for measuring.
const uint SCRIPT_IS_DRY = 1u;

// status_words[STATUS_FLAGS] gets STATUS_TURNS when a lane had no loop turns left (shared/turns.glsl). Its photon and
// those after it are missing: with rounds > 1 start the pass anew with fewer rounds; with rounds = 1 only the photons
// marked in late_bits are missing, and the interpreter takes them. STATUS_MOST_TURNS: the most turns one lane took.
const uint STATUS_FLAGS = 0u;
const uint STATUS_MOST_TURNS = 1u;
const uint STATUS_WORDS = 2u;
const uint STATUS_TURNS = 1u;

// fault_words has FAULT_STRIDE words a site: photons counted, the lowest photon (start: 0xffffffff).
const uint FAULT_STRIDE = 2u;

// A neighbour query has QUERY_STRIDE uniform words: the first word of its rows in neighbor_rows, numbers a row (k), the
// photon of the first row, rows. A list in a uniform variable has the first word and its length.
const uint QUERY_STRIDE = 4u;

// A histogram has HISTOGRAM_STRIDE uniform words: lo, hi, bins, its first word in histogram_words. There: the bins,
// then below lo, above hi, not finite.
const uint HISTOGRAM_STRIDE = 4u;
const uint HISTOGRAM_EXTRA = 3u;

// Moments of pushed points in lane_words and uniform_words: count, first photon, first point (3), mean (3),
// products (6: xx xy xz yy yz zz).
const uint MOMENTS_WORDS = 14u;
// A decomposition in uniform_words: dimensions (0: none), eigenvalues (3), eigenvectors (3 × 3), mean (3).
const uint DECOMPOSITION_WORDS = 16u;

SHARED_END

#endif
