// SPDX-License-Identifier: Apache-2.0
// Buffer views compressed by EXT_meshopt_compression.
#pragma once

#include <span>

#include "core/json_place.h"

namespace photonloupe {

// Bytes of the view once decompressed; refuses parameters that the extension does not allow.
std::uint64_t measure_meshopt(const JsonPlace& extension);

// Decodes, and undoes the filter; `target` has the measured size.
void decode_meshopt(const JsonPlace& extension, std::span<const unsigned char> source, std::span<unsigned char> target);

} // namespace photonloupe
