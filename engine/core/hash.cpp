// SPDX-License-Identifier: Apache-2.0
// Content hashes by xxHash.
#include "core/hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace photonloupe {

std::string hash_bytes(std::string_view bytes) {
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    constexpr char DIGITS[] = "0123456789abcdef";
    std::string text;
    for (const XXH64_hash_t half : {hash.high64, hash.low64})
        for (int shift = 60; shift >= 0; shift -= 4)
            text += DIGITS[half >> shift & 15];
    return text;
}

} // namespace photonloupe
