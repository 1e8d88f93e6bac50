// SPDX-License-Identifier: Apache-2.0
// Counter-based random numbers: every number is a function of (seed, emitted index, bounce, dimension) and of nothing
// else. One text for C++ and GLSL. Hash: pcg4d (Jarzynski and Olano 2020); Sobol: Owen-scrambled by a hash
// (Laine and Karras 2011, constants of Burley 2020).
#ifndef PHOTONLOUPE_SHARED_RANDOM_H
#define PHOTONLOUPE_SHARED_RANDOM_H

#include "shared/types.h"

SHARED_BEGIN

SHARED_INLINE uvec4 hash_pcg4d(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v = v ^ (v >> 16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// Four uniform 32-bit words.
SHARED_INLINE uvec4 random_words(uint seed, uint index, uint bounce, uint dimension) {
    return hash_pcg4d(uvec4(index, bounce, dimension, seed));
}

// Uniform 32-bit word.
SHARED_INLINE uint random_bits(uint seed, uint index, uint bounce, uint dimension) {
    return random_words(seed, index, bounce, dimension).x;
}

// Uniform in [0, 1): the upper 24 bits, so that the conversion is exact.
SHARED_INLINE float to_unit_float(uint bits) { return float(bits >> 8u) * (1.0f / 16777216.0f); }

SHARED_INLINE uint reverse_bits(uint x) {
    x = ((x >> 1u) & 0x55555555u) | ((x & 0x55555555u) << 1u);
    x = ((x >> 2u) & 0x33333333u) | ((x & 0x33333333u) << 2u);
    x = ((x >> 4u) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4u);
    x = ((x >> 8u) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8u);
    return (x >> 16u) | (x << 16u);
}

// Owen scrambling of a 32-bit fraction: each bit is flipped by a hash of the bits above it.
SHARED_INLINE uint scramble_owen(uint x, uint seed) {
    x = reverse_bits(x);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverse_bits(x);
}

// The first five dimensions of the Sobol sequence as 32-bit fractions (dimension 0: van der Corput; 1: x + 1;
// 2: x² + x + 1 with m = 1, 3; 3: x³ + x + 1 with m = 1, 3, 1; 4: x³ + x² + 1 with m = 1, 1, 1; their matrices are built
// column by column from the recurrence).
SHARED_INLINE uint sobol_bits(uint index, uint dimension) {
    if (dimension == 0u)
        return reverse_bits(index);
    if (dimension == 1u) {
        // The matrix is Pascal's triangle modulo 2, a fivefold tensor product: one butterfly for each factor.
        uint x = reverse_bits(index);
        x ^= (x << 1u) & 0xaaaaaaaau;
        x ^= (x << 2u) & 0xccccccccu;
        x ^= (x << 4u) & 0xf0f0f0f0u;
        x ^= (x << 8u) & 0xff00ff00u;
        return x ^ ((x << 16u) & 0xffff0000u);
    }
    uint result = 0u;
    if (dimension > 2u) {
        uint oldest = 0x80000000u;
        uint middle = dimension == 3u ? 0xc0000000u : 0x40000000u;
        uint newest = 0x20000000u;
        for (; index != 0u; index >>= 1u) {
            if ((index & 1u) != 0u)
                result ^= oldest;
            uint next = (dimension == 3u ? middle : newest) ^ oldest ^ (oldest >> 3u);
            oldest = middle;
            middle = newest;
            newest = next;
        }
        return result;
    }
    uint older = 0x80000000u;
    uint newer = 0xc0000000u;
    for (; index != 0u; index >>= 1u) {
        if ((index & 1u) != 0u)
            result ^= older;
        uint next = newer ^ older ^ (older >> 2u);
        older = newer;
        newer = next;
    }
    return result;
}

SHARED_INLINE uint sample_sobol(uint seed, uint index, uint dimension) {
    return scramble_owen(sobol_bits(index, dimension), random_bits(seed, 0xffffffffu, 0xffffffffu, dimension));
}

SHARED_END

#endif
