// SPDX-License-Identifier: Apache-2.0
// Where one image differs from another, and by how much.
#pragma once

#include "image/image.h"

namespace photonloupe::inspect {

struct ErrorMap {
    std::uint32_t width = 0, height = 0;
    std::vector<float> absolute; // luminance of |a − b|, in the images' unit
    std::vector<float> relative; // the same over √(b² + 0.01·mean(b)²)
    double rmse = 0;             // √mean((a − b)²) over pixels and channels
    double relmse = 0;           // mean((a − b)² / (b² + 0.01·mean(b)²))
};

// `b` is the reference. Throws Error for images of different sizes, and for pixels that are not finite.
ErrorMap measure_errors(const Image& a, const Image& b);

// Colors of errors by viridis, linear; `full` is the error at its bright end, 0: the largest one.
Image paint_errors(const ErrorMap& map, bool is_relative, float full = 0);

} // namespace photonloupe::inspect
