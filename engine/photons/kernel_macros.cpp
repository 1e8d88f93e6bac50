// SPDX-License-Identifier: Apache-2.0
// Writes the macros.
#include "photons/kernel_macros.h"

#include <algorithm>

namespace photonloupe {

std::string write_each(const std::string& name, std::uint32_t first, std::uint32_t end, const char* suffix) {
    std::string text = name + "(DO)";
    for (std::uint32_t i = first; i < end; ++i)
        text += " DO(" + std::to_string(i) + suffix + ")";
    return text;
}

std::string write_sort_network(std::uint32_t size) {
    std::string text = "SORT_NETWORK(DO)";
    for (std::uint32_t p = 1; p < size; p *= 2)
        for (std::uint32_t k = p; k >= 1; k /= 2)
            for (std::uint32_t j = k % p; j + k < size; j += 2 * k)
                for (std::uint32_t i = 0; i < std::min(k, size - j - k); ++i)
                    if ((i + j) / (2 * p) == (i + j + k) / (2 * p))
                        text += " DO(" + std::to_string(i + j) + ", " + std::to_string(i + j + k) + ")";
    return text;
}

} // namespace photonloupe
