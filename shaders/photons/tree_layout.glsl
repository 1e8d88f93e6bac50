// SPDX-License-Identifier: Apache-2.0
// Where a node of the complete kd-tree begins: at TREE_TILE·floor(tiles · j / 2^level), without overflow.
#include "shared/photons.h"

uint find_first_position(uint photon_count, uint node, uint level) {
    uint high, low;
    umulExtended((photon_count + TREE_TILE - 1u) / TREE_TILE, node, high, low);
    uint tile = level == 0u ? low : (high << (32u - level)) | (low >> level);
    return min(TREE_TILE * tile, photon_count);
}

// Level of a heap index.
uint find_level(uint heap_index) { return uint(findMSB(heap_index)); }
