// SPDX-License-Identifier: Apache-2.0
// Integers in the order of floats that are no NaN; both zeros are one.
const int LEAST_KEY = int(0x80000000u);
const int GREATEST_KEY = 0x7fffffff;

int make_key(float value) {
    int bits = floatBitsToInt(value);
    bits = bits == LEAST_KEY ? 0 : bits;
    return bits ^ ((bits >> 31) & 0x7fffffff);
}

float read_key(int key) { return intBitsToFloat(key ^ ((key >> 31) & 0x7fffffff)); }
