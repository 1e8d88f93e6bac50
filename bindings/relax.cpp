// SPDX-License-Identifier: Apache-2.0
// Binds engine/relax: the periodogram of points.
#include "binding.h"

#include "relax/measure_spectrum.h"

namespace photonloupe::bindings {
namespace {

nb::tuple measure(OpenDevice& open, Matrix<const double, 2> points, std::array<double, 2> radius, nb::object progress) {
    const auto* first = reinterpret_cast<const glm::dvec2*>(points.data());
    Spectrum spectrum = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return measure_spectrum(open.device, {first, points.shape(0)}, {radius[0], radius[1]}, asked);
    });
    std::vector<std::int32_t> frequencies;
    frequencies.reserve(2 * spectrum.frequencies.size());
    for (const glm::ivec2& frequency : spectrum.frequencies)
        frequencies.insert(frequencies.end(), {frequency.x, frequency.y});
    return nb::make_tuple(own_array(std::move(frequencies), 2), own_array(std::move(spectrum.power)));
}

} // namespace

void bind_relax(nb::module_& module) {
    module.def("measure_spectrum", &measure, nb::arg("device"), nb::arg("points"), nb::arg("radius"),
               nb::arg("progress").none() = nb::none(),
               "Frequencies (m, 2) of a half plane up to `radius` cycles over the sides, and the power (m,) of points "
               "(n, 2) in sides.");
}

} // namespace photonloupe::bindings
