// SPDX-License-Identifier: Apache-2.0
// The radius of queries that photons/find_radii.comp leaves, one a subgroup: eight tree nodes are tested at once, those
// nearest entered first, and photons within the bound gathered in a list that shrinks it. A query that spends its turns
// goes on in the next dispatch where it stopped, so that whatever the photons are like it is answered.
// Inputs: the tree, the queries, singles. Outputs: radii (see photons/search_radius.glsl), unanswered (without CUT_TIES
// TIES_UNCOUNTED where more photons lie at just the radius than the list holds). In and out: saved_searches.
#include "shared/prelude.glsl"
#include "photons/tree_texels.glsl"
#include "photons/candidates.glsl"
#include "photons/radii.glsl"
#include "shared/turns.glsl"

#define WIDTH gl_WorkGroupSize.x
#define LANE gl_LocalInvocationID.x

#include "photons/select_list.glsl"
#pragma binding readonly uvec2 singles
#pragma binding writeonly uint unanswered
#pragma binding coherent vec4 radii
#pragma binding coherent uint saved_searches

layout(push_constant) uniform Push { GatherSettings settings; };

const uint NO_BOUND = 0x7f800000u; // as a measure, of none
// Photons kept: without CUT_TIES one more than the rank, which tells whether more tie.
#ifdef CUT_TIES
#define KEPT settings.rank
#else
#define KEPT (settings.rank + 1u)
#endif

shared uint stack_node[TREE_STACK_SIZE];
shared uvec3 stack_bound[TREE_STACK_SIZE]; // no photon of the node is before it

// What is known of the query: the list's length, the last of the rank smallest, and the nodes that wait.
struct Selection {
    uint count;
    uint depth;
    uvec3 last; // x NO_BOUND: fewer than the rank were found
};

Selection selection;

// Pushes those of the node's descendants, up to three levels down, that may hold something, farthest first.
void push_descendants(Query own, uint node) {
    uint level = find_level(node);
    uint step = min(TREE_STEP_LEVELS, settings.leaf_level - level);
    uint child = (node << step) + min(LANE, (1u << step) - 1u);
    uvec3 bound = bound_entry(own, load_node(child));
    bool reached = LANE < (1u << step) && bound.x < NO_BOUND && is_before(bound, selection.last);
    bound = reached ? bound : uvec3(0xffffffffu);
    uint nearer = 0u; // survivors in front of this one
    for (uint other = 0u; other < TREE_FANOUT; ++other) {
        uvec3 theirs = share_entry(bound, other);
        nearer += uint(is_before(theirs, bound) || (theirs == bound && other < LANE));
    }
    uint count = count_lanes(find_lanes(reached));
    if (reached) {
        stack_node[selection.depth + count - 1u - nearer] = child;
        stack_bound[selection.depth + count - 1u - nearer] = bound;
    }
    selection.depth += count;
    synchronize();
}

// Appends a leaf's photons within the bound to the list.
void list_leaf(uint leaf) {
    uint j = leaf - (1u << settings.leaf_level);
    uint end = find_first_position(settings.photon_count, j + 1u, settings.leaf_level);
    for (uint base = find_first_position(settings.photon_count, j, settings.leaf_level); base < end; base += WIDTH) {
        turns += 2u;
        Candidate other = load_candidate(min(base + LANE, end - 1u), base + LANE < end);
        uvec3 entry = uvec3(floatBitsToUint(measure_candidate(other)), break_tie(other), other.id);
        bool found = base + LANE < end && entry.x < NO_BOUND && (is_before(entry, selection.last));
        uvec2 ballot = find_lanes(found);
        if (found) list[selection.count + count_before(ballot)] = entry;
        selection.count += count_lanes(ballot);
    }
    synchronize();
}

// Drops what lies beyond the rank once enough has come in.
void cut_selection() {
    uint full = settings.rank + max(settings.rank / 4u, TREE_LEAF_PHOTONS / 2u);
    if (selection.count < full && (selection.count < KEPT || selection.last.x != NO_BOUND)) return;
    selection.last = cut_list(selection.count, KEPT);
    selection.count = min(selection.count, KEPT);
}

void search_tree() {
    Query own = get_query();
    while (selection.depth > 0u && has_turns_left()) {
        --selection.depth;
        turns += TREE_FANOUT + 3u;
        uint node = stack_node[selection.depth];
        uvec3 bound = stack_bound[selection.depth];
        synchronize();
        if (!is_before(bound, selection.last)) continue;
        if (find_level(node) < settings.leaf_level) {
            push_descendants(own, node);
        } else {
            list_leaf(node);
            cut_selection();
        }
    }
}

// Words of a search: flag, count, depth, last, the stack and the list.
uint my_slot;

uint locate_save() { return my_slot * (6u + 4u * TREE_STACK_SIZE + 3u * LIST_CAPACITY); }

void start_search() {
    uint at = locate_save();
    bool is_resumed = saved_searches[at] != 0u;
    selection = Selection(0u, 1u, uvec3(NO_BOUND, 0xffffffffu, 0xffffffffu));
    if (is_resumed)
        selection = Selection(saved_searches[at + 1u], saved_searches[at + 2u],
                              uvec3(saved_searches[at + 3u], saved_searches[at + 4u], saved_searches[at + 5u]));
    if (LANE == 0u) {
        stack_node[0] = 1u;
        stack_bound[0] = uvec3(0u);
    }
    synchronize();
    at += 6u;
    for (uint i = LANE; i < selection.depth && is_resumed; i += WIDTH) {
        stack_node[i] = saved_searches[at + 4u * i];
        stack_bound[i] = uvec3(saved_searches[at + 4u * i + 1u], saved_searches[at + 4u * i + 2u], saved_searches[at + 4u * i + 3u]);
    }
    at += 4u * TREE_STACK_SIZE;
    for (uint i = LANE; i < selection.count; i += WIDTH)
        list[i] = uvec3(saved_searches[at + 3u * i], saved_searches[at + 3u * i + 1u], saved_searches[at + 3u * i + 2u]);
    turns += (selection.depth + selection.count) / WIDTH + 2u;
    synchronize();
}

void save_search() {
    uint at = locate_save();
    if (LANE == 0u) {
        saved_searches[at] = 1u;
        saved_searches[at + 1u] = selection.count;
        saved_searches[at + 2u] = selection.depth;
        saved_searches[at + 3u] = selection.last.x;
        saved_searches[at + 4u] = selection.last.y;
        saved_searches[at + 5u] = selection.last.z;
    }
    at += 6u;
    for (uint i = LANE; i < selection.depth; i += WIDTH) {
        saved_searches[at + 4u * i] = stack_node[i];
        saved_searches[at + 4u * i + 1u] = stack_bound[i].x;
        saved_searches[at + 4u * i + 2u] = stack_bound[i].y;
        saved_searches[at + 4u * i + 3u] = stack_bound[i].z;
    }
    at += 4u * TREE_STACK_SIZE;
    for (uint i = LANE; i < selection.count; i += WIDTH) {
        saved_searches[at + 3u * i] = list[i].x;
        saved_searches[at + 3u * i + 1u] = list[i].y;
        saved_searches[at + 3u * i + 2u] = list[i].z;
    }
}

void write_radius(uint query) {
    uint found = min(selection.count, settings.rank);
    bool has_next = selection.count > settings.rank; // one more is kept, which tells whether the last ties
    uvec3 last = selection.count > 0u ? cut_list(selection.count, settings.rank) : uvec3(0u);
    bool takes_all = found < settings.rank;
    // All before this are members; where the last is one too, all up to it.
    uvec2 cut = takes_all ? uvec2(0xffffffffu) : uvec2(last.y, last.z + settings.includes_last);
#ifdef CUT_TIES
    vec4 radius = vec4(uintBitsToFloat(last.x), uintBitsToFloat(cut.x), uintBitsToFloat(cut.y), float(found));
#else
    uint equal = 0u;
    for (uint i = LANE; i < found; i += WIDTH) equal += uint(list[i].x == last.x);
    equal = sum_lanes(equal);
    vec4 radius = found > 0u ? share_ties(uintBitsToFloat(last.x), found, found - equal, equal) : vec4(0.0);
    bool ties_on = has_next && list[settings.rank].x == last.x && last.x != 0u;
#endif
    if (LANE == 0u) {
        radii[query] = radius;
#ifdef CUT_TIES
        unanswered[my_slot] = 0u;
#else
        unanswered[my_slot] = ties_on ? TIES_UNCOUNTED : 0u;
#endif
    }
}

void main() {
    uint query = singles[settings.first + gl_WorkGroupID.x].x;
    my_slot = singles[settings.first + gl_WorkGroupID.x].y;
    take_query(query * settings.stride, settings.period, settings.flatness);
    start_search();
    search_tree();
    if (selection.depth == 0u) write_radius(query);
    else save_search();
}
