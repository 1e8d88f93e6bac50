// SPDX-License-Identifier: Apache-2.0
// Which photon a lane gathers for. As a rule a subgroup takes photons that stand side by side in the tree, batch after
// batch; with SINGLY each takes one photon of a list, so that it has a workgroup's loop turns to itself.
// Inputs: singles (tree positions, with SINGLY). Outputs: unanswered (a flag for each subgroup's run of photons).
#pragma binding readonly uint singles
#pragma binding writeonly uint unanswered

#ifdef SINGLY
#define BATCH_COUNT(gather) 1u
#else
#define BATCH_COUNT(gather) gather.batches
#endif

// Sets the lane's tree position; false for lanes that have none.
bool take_turn(GatherSettings gather, uint batch, out uint position) {
#ifdef SINGLY
    position = singles[gather.first + gl_WorkGroupID.x];
    return LANE == 0u;
#else
    uint turn = (gl_WorkGroupID.x * gather.batches + batch) * WIDTH + LANE;
    position = gather.first + min(turn, gather.count - 1u);
    return turn < gather.count;
#endif
}

void report_turn(bool has_photon, bool is_answered, uint position) {
    if (has_photon && !is_answered) unanswered[position / WIDTH] = 1u;
}
