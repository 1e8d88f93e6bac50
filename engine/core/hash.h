// SPDX-License-Identifier: Apache-2.0
// Content hashes (XXH3, 128 bits, hex) for caches and provenance; not for secrets.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace photonloupe {

inline constexpr std::size_t HASH_TEXT_LENGTH = 32;

std::string hash_bytes(std::string_view bytes);

} // namespace photonloupe
