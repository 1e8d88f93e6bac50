// SPDX-License-Identifier: Apache-2.0
// Counts loop turns. Mesa's software device stops every loop of an invocation silently once all its loops together
// have turned 65,535 times, so kernels with long loops count, stop early themselves and say so.

const uint TURN_BUDGET = 60000u;
uint turns = 0u;
uint turn_limit = TURN_BUDGET; // of what is being done

bool has_turns_left() { return turns < turn_limit; }
