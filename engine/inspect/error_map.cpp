// SPDX-License-Identifier: Apache-2.0
// Sums in double precision, in pixel order.
#include "inspect/error_map.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "inspect/photon_colors.h"

namespace photonloupe::inspect {
namespace {

// Share of the mean square that keeps dark pixels from deciding alone (METHODS §12).
constexpr double RELATIVE_FLOOR = 0.01;

void require_finite(const Image& image, const char* which) {
    const auto bad =
        std::find_if(image.rgb.begin(), image.rgb.end(), [](float value) { return !std::isfinite(value); });
    if (bad == image.rgb.end())
        return;
    const auto pixel = static_cast<std::size_t>(bad - image.rgb.begin()) / 3;
    throw Error(std::string("error map: ") + which + " is not finite at row " + std::to_string(pixel / image.width) +
                ", column " + std::to_string(pixel % image.width));
}

// No error of nothing is none, also where the reference is black everywhere.
double divide(double error, double by) {
    return error > 0 ? error / by : 0.0;
}

} // namespace

ErrorMap measure_errors(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height)
        throw Error("error map: the images are " + std::to_string(a.width) + " × " + std::to_string(a.height) +
                    " and " + std::to_string(b.width) + " × " + std::to_string(b.height) + " pixels; they must match");
    check_image(a, "error map");
    check_image(b, "error map");
    require_finite(a, "the image");
    require_finite(b, "the reference");
    double sum = 0, squares = 0, relative_squares = 0;
    for (const float value : b.rgb)
        sum += value;
    const double count = static_cast<double>(b.rgb.size());
    const double floor = RELATIVE_FLOOR * (sum / count) * (sum / count);
    ErrorMap map{a.width, a.height, {}, {}};
    for (std::size_t at = 0; at < b.rgb.size(); at += 3) {
        glm::vec3 errors, relative;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double reference = b.rgb[at + channel];
            const double error = std::abs(a.rgb[at + channel] - reference);
            const double scale2 = reference * reference + floor;
            squares += error * error;
            relative_squares += divide(error * error, scale2);
            errors[channel] = static_cast<float>(error);
            relative[channel] = static_cast<float>(divide(error, std::sqrt(scale2)));
        }
        map.absolute.push_back(find_luminance(errors));
        map.relative.push_back(find_luminance(relative));
    }
    map.rmse = std::sqrt(squares / count);
    map.relmse = relative_squares / count;
    return map;
}

Image paint_errors(const ErrorMap& map, bool is_relative, float full) {
    const std::vector<float>& errors = is_relative ? map.relative : map.absolute;
    if (!(full > 0))
        full = errors.empty() ? 0.0f : *std::max_element(errors.begin(), errors.end());
    Image image{map.width, map.height, {}, {}};
    for (const float error : errors) {
        const glm::vec3 color = linearize(map_color(Colormap::viridis, full > 0 ? error / full : 0.0f));
        image.rgb.insert(image.rgb.end(), {color.r, color.g, color.b});
    }
    return image;
}

} // namespace photonloupe::inspect
