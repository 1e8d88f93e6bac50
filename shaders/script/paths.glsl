// SPDX-License-Identifier: Apache-2.0
// Where photons' paths begin, and how many vertices they have.
#pragma binding readonly uint path_starts

// First vertex and count; none of a photon that does not exist.
uvec2 find_path(int id) {
    uint at = uint(max(id, 0));
    uint first = path_starts[at], next = path_starts[at + 1u];
    return id < 0 ? uvec2(0u) : uvec2(first, next - first);
}
