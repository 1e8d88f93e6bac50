// SPDX-License-Identifier: Apache-2.0
// Macros that unroll kernels' loops over what is known before: loops that turn count against the device's limit, and
// arrays that are not indexed by constants lie in memory.
#pragma once

#include <cstdint>
#include <string>

namespace photonloupe {

// "NAME(DO) DO(first) … DO(end - 1)", each number with `suffix` behind.
std::string write_each(const std::string& name, std::uint32_t first, std::uint32_t end, const char* suffix = "");

// "SORT_NETWORK(DO) DO(i, j) …": comparators of Batcher's odd-even merge sort for `size` (a power of two) values.
std::string write_sort_network(std::uint32_t size);

} // namespace photonloupe
