// SPDX-License-Identifier: Apache-2.0
// Nodes that several subgroups split together, step by step, each step a kernel: choose_brackets, keep_between,
// find_pivots, count_lefts, move_parts.
#include "photons/tree_source.glsl"
#include "photons/select_key.glsl"
#pragma binding coherent TreeBracket brackets
#pragma binding coherent uint left_counts

Key get_lo(uint node) { return Key(int(brackets[node].lo_hi.x), int(brackets[node].lo_hi.y)); }
Key get_hi(uint node) { return Key(int(brackets[node].lo_hi.z), int(brackets[node].lo_hi.w)); }

// The part of a node that this workgroup takes.
struct Part {
    uint node, first, end;
};

Part find_part() {
    uint node = gl_WorkGroupID.x / build.parts;
    uint begin = find_first_position(build.photon_count, node, build.level);
    begin += gl_WorkGroupID.x % build.parts * TREE_PART;
    uint end = find_first_position(build.photon_count, node + 1u, build.level);
    return Part(node, min(begin, end), min(begin + TREE_PART, end));
}

uint find_split(uint node) { return find_first_position(build.photon_count, 2u * node + 1u, build.level + 1u); }
