// SPDX-License-Identifier: Apache-2.0
// Which photon a lane gathers for. As a rule a subgroup takes photons that stand side by side in the tree, batch after
// batch; with SINGLY each takes one photon of a list, so that it has a workgroup's loop turns to itself.
// Inputs: singles (tree positions, with SINGLY). Outputs: unanswered (a flag for each subgroup's run of photons, or
// for each single one).
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

// Clears the flag of photons that were answered: it was set beforehand, because a workgroup that the device stops for
// its loop turns says nothing.
void report_turn(GatherSettings gather, bool has_photon, bool is_answered, uint position) {
    bool all_answered = subgroupAll(is_answered || !has_photon) && subgroupAny(has_photon);
#ifdef SINGLY
    uint flag = gather.first + gl_WorkGroupID.x;
#else
    uint flag = subgroupMin(position) / WIDTH;
#endif
    if (LANE == 0u && all_answered) unanswered[flag] = 0u;
}
