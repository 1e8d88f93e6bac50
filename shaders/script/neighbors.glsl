// SPDX-License-Identifier: Apache-2.0
// Neighbour lists: rows of ids, nearest first, -1 behind the last. A list is its first word and its length.
#pragma binding readonly int neighbor_rows

// The row of a photon (-1: none) in a query whose uniform words begin at `words`; k is 0 where it is out of range.
ivec2 find_neighbors(uint words, int id, uint bad_query) {
    uint first = uniform_words[words], k = uniform_words[words + 1u];
    fault_if(k == 0u, bad_query);
    uint row = uint(id) - uniform_words[words + 2u];
    if (row >= uniform_words[words + 3u] || id < 0) return ivec2(0);
    int start = int(first + row * k);
    int low = 0, high = int(k); // the length is between them
    for (int middle = high; low < high && take_turn(); middle = (low + high + 1) / 2)
        if (neighbor_rows[start + middle - 1] >= 0) low = middle;
        else high = middle - 1;
    return ivec2(start, low);
}

// `index` is -1 for none.
int read_neighbor(ivec2 list, int index) {
    int found = neighbor_rows[list.x + max(index, 0)];
    return index < 0 ? 0 : found;
}
