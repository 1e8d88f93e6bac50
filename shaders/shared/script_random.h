// SPDX-License-Identifier: Apache-2.0
// The script language's random(i, salt): a stream of its own, apart from the photons'. One text for C++ and GLSL.
#ifndef PHOTONLOUPE_SHARED_SCRIPT_RANDOM_H
#define PHOTONLOUPE_SHARED_SCRIPT_RANDOM_H

#include "shared/random.h"

SHARED_BEGIN

// No tracing dimension is this large.
#define SCRIPT_RANDOM_DIMENSION 0x73637269u

SHARED_INLINE float draw_script_random(uint seed, uint index, uint salt) {
    return to_unit_float(random_bits(seed, index, salt, SCRIPT_RANDOM_DIMENSION));
}

SHARED_END

#endif
