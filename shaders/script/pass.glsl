// SPDX-License-Identifier: Apache-2.0
// What every pass of a script has: push constants, faults of the present photon, loop turns and fuel.
// Define FAULT_WORDS.
#include "shared/script.h"
#include "shared/turns.glsl"
#pragma binding uint status_words
#pragma binding uint fault_words

layout(push_constant) uniform Push { ScriptPass settings; };

#define NAN uintBitsToFloat(0x7fc00000u)

// Compilers that see a 0 take x · 0 and 0 / x for 0, and x / 0 for anything.
#define ZERO uintBitsToFloat(settings.zero)
float real(int x) { return float(x ^ int(settings.zero)); }

int photon; // the loop's own

uint fault_bits[FAULT_WORDS]; // a bit for each site of the pass
uint fuel_left;
bool is_out_of_fuel;
bool is_committing; // false: nothing but registers is written

void fault_if(bool is_bad, uint site) {
    fault_bits[site >> 5u] |= is_bad ? 1u << (site & 31u) : 0u;
}

// Before every turn of a loop with a bound.
bool take_turn() { return ++turns < TURN_BUDGET; }

// Before every turn of any other loop. After the last, the rest of the body is run for nothing.
bool take_step(uint site) {
    bool is_empty = fuel_left == 0u;
    fault_if(is_empty, site);
    is_out_of_fuel = is_out_of_fuel || is_empty;
    fuel_left -= is_empty ? 0u : 1u;
    return ++turns < TURN_BUDGET && !is_empty;
}

// After a loop: the device counts its longest lane's turns against every lane.
void share_turns() { turns = subgroupMax(turns); }

bool is_photon_complete() { return !is_out_of_fuel && has_turns_left(); }

float check_set(bool is_set, float value, uint site) {
    fault_if(!is_set, site);
    return is_set ? value : NAN;
}
int check_set(bool is_set, int value, uint site) {
    fault_if(!is_set, site);
    return is_set ? value : 0;
}

// Where an index falls in [0, size); -1 and a fault outside.
int find_place(int index, int size, uint outside) {
    bool is_good = uint(index) < uint(size);
    fault_if(!is_good, outside);
    return is_good ? index : -1;
}
int find_place(float index, int size, uint outside, uint not_whole) {
    bool is_whole = index == floor(index) && abs(index) < INFINITY;
    bool is_good = is_whole && index >= 0.0 && index < float(size);
    fault_if(!is_whole, not_whole);
    fault_if(is_whole && !is_good, outside);
    return is_good ? int(index) : -1;
}

// An index that is looked at only where the one before it was good.
int find_place_after(int before, int index, int size, uint outside) {
    return before < 0 ? -1 : find_place(index, size, outside);
}
int find_place_after(int before, float index, int size, uint outside, uint not_whole) {
    return before < 0 ? -1 : find_place(index, size, outside, not_whole);
}

bool is_inside(int index, int size, uint outside) { return find_place(index, size, outside) >= 0; }

bool is_dry() { return (settings.flags & SCRIPT_IS_DRY) != 0u; }

void start_photon() {
    fuel_left = settings.fuel;
    is_out_of_fuel = false;
}

// Of the sites first_site … first_site + 31.
void count_faults(uint bits, uint first_site) {
    while (bits != 0u) {
        uint site = first_site + uint(findLSB(bits));
        bits &= bits - 1u;
        ++turns;
        atomicAdd(fault_words[site * FAULT_STRIDE], 1u);
        atomicMin(fault_words[site * FAULT_STRIDE + 1u], uint(photon));
    }
}

void report_turns() {
    uint most = subgroupMax(turns);
    if (!subgroupElect()) return;
    atomicMax(status_words[STATUS_MOST_TURNS], most);
    if (most >= TURN_BUDGET) atomicOr(status_words[STATUS_FLAGS], STATUS_TURNS);
}
