// SPDX-License-Identifier: Apache-2.0
// Which query a lane answers. As a rule a subgroup takes queries that stand side by side in their order, batch after
// batch, each with its share of the workgroup's loop turns; with SINGLY it takes one query of a list and goes on with it
// in the next dispatch, where it stopped, if its turns did not suffice (photons/stream_members.glsl).
// Inputs: singles (with SINGLY: x query, y its slot). Outputs: unanswered (a flag a query, or a slot, set beforehand: a
// workgroup that the device stops for its loop turns says nothing).
#pragma binding readonly uvec2 singles
#pragma binding writeonly uint unanswered

#ifdef SINGLY
#define BATCH_COUNT(gather) 1u
#else
#define BATCH_COUNT(gather) gather.batches
#endif

// Sets the lane's query; false for lanes that have none.
bool take_turn(GatherSettings gather, uint batch, out uint query) {
#ifdef SINGLY
    uvec2 single = singles[gather.first + gl_WorkGroupID.x];
    query = single.x;
    my_slot = single.y;
    return LANE == 0u;
#else
    turn_limit = turns + TURN_BUDGET / gather.batches;
    uint turn = (gl_WorkGroupID.x * gather.batches + batch) * WIDTH + LANE;
    query = gather.first + min(turn, gather.count - 1u);
    return turn < gather.count;
#endif
}

// Clears the flag of a query that was answered.
void report_turn(GatherSettings gather, bool has_query, bool is_answered, uint query) {
#ifdef SINGLY
    if (has_query && is_answered) unanswered[my_slot] = 0u;
#else
    if (has_query && is_answered) unanswered[query] = 0u;
#endif
}
