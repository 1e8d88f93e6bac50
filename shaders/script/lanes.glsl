// SPDX-License-Identifier: Apache-2.0
// Running values of reductions (engine/script/interpret/reductions.h): a word for each slot of a block and lane of 64.
#pragma binding uint lane_words

uint lane_base; // of the present block and lane

uint locate_slot(uint slot) { return lane_base + slot * SCRIPT_LANES; }
float load_real(uint slot) { return uintBitsToFloat(lane_words[locate_slot(slot)]); }
uint load_word(uint slot) { return lane_words[locate_slot(slot)]; }
int load_integer(uint slot) { return int(lane_words[locate_slot(slot)]); }
void store(uint slot, float value) { lane_words[locate_slot(slot)] = floatBitsToUint(value); }
void store(uint slot, uint value) { lane_words[locate_slot(slot)] = value; }
void store(uint slot, int value) { lane_words[locate_slot(slot)] = uint(value); }

// Elements of arrays; `place` is -1 for none.
void sum_element(uint slot, int place, float value) {
    if (place >= 0 && is_committing) store(slot + uint(place), load_real(slot + uint(place)) + value);
}
void sum_element(uint slot, int place, int value) {
    if (place >= 0 && is_committing) store(slot + uint(place), load_integer(slot + uint(place)) + value);
}
void minimum_element(uint slot, int place, float value) {
    if (place >= 0 && is_committing) store(slot + uint(place), script_min(load_real(slot + uint(place)), value));
}
void minimum_element(uint slot, int place, int value) {
    if (place >= 0 && is_committing) store(slot + uint(place), script_min(load_integer(slot + uint(place)), value));
}
void maximum_element(uint slot, int place, float value) {
    if (place >= 0 && is_committing) store(slot + uint(place), script_max(load_real(slot + uint(place)), value));
}
void maximum_element(uint slot, int place, int value) {
    if (place >= 0 && is_committing) store(slot + uint(place), script_max(load_integer(slot + uint(place)), value));
}

// Least and greatest: values in `slot` …, then `size` photons. True where the value wins.
bool choose_element(uint slot, uint size, int place, float value, bool least) {
    if (place < 0 || !is_committing) return false;
    float held = load_real(slot + uint(place));
    if (!(least ? value < held : value > held)) return false;
    store(slot + uint(place), value);
    store(slot + size + uint(place), photon);
    return true;
}
bool choose_element(uint slot, uint size, int place, int value, bool least) {
    if (place < 0 || !is_committing) return false;
    int held = load_integer(slot + uint(place));
    if (!(least ? value < held : value > held)) return false;
    store(slot + uint(place), value);
    store(slot + size + uint(place), photon);
    return true;
}
