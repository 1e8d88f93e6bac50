// SPDX-License-Identifier: Apache-2.0
// Binds engine/estimate: irradiance at points, and rendering.
#include "binding.h"

#include "choices.h"
#include "photons/map_columns.h"

namespace photonloupe::bindings {
namespace {

nb::ndarray<nb::numpy, float> estimate(OpenDevice& open, Photons& photons, Matrix<const double, 3> points,
                                       Matrix<const float, 3> normals, std::uint32_t k, const std::string& kernel,
                                       nb::object progress) {
    const std::vector<glm::vec4> local = localize_points(photons.map, {points.data(), points.size()});
    std::vector<glm::vec4> directions(normals.shape(0));
    for (std::size_t i = 0; i < directions.size(); ++i)
        directions[i] = {normals(i, 0), normals(i, 1), normals(i, 2), 0.0f};
    const EstimateSettings settings{k, parse_kernel(kernel)};
    std::vector<float> rgb = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        const gpu::Buffer irradiance = open.workbench.estimate_irradiance(photons, local, directions, settings, asked);
        std::vector<float> values;
        for (const glm::vec4& value : irradiance.read<glm::vec4>(local.size()))
            values.insert(values.end(), {value.r, value.g, value.b});
        return values;
    });
    return own_array(std::move(rgb), 3);
}

RenderSettings read_settings(const nb::dict& given) {
    RenderSettings settings;
    settings.camera = read_camera(given["camera"]);
    settings.width = nb::cast<std::uint32_t>(given["width"]);
    settings.height = nb::cast<std::uint32_t>(given["height"]);
    settings.samples = nb::cast<std::uint32_t>(given["samples"]);
    settings.mode = parse_mode(nb::cast<std::string>(given["mode"]));
    settings.estimate.k = nb::cast<std::uint32_t>(given["k"]);
    settings.estimate.kernel = parse_kernel(nb::cast<std::string>(given["kernel"]));
    settings.seed = nb::cast<std::uint32_t>(given["seed"]);
    return settings;
}

nb::ndarray<nb::numpy, float, nb::ndim<3>> render(OpenDevice& open, const Scene& scene, nb::object photons,
                                                  const nb::dict& given, nb::object progress) {
    const RenderSettings settings = read_settings(given);
    Photons* map = photons.is_none() ? nullptr : nb::cast<Photons*>(photons);
    Image image = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return open.workbench.render(scene, map, settings, asked);
    });
    return own_pixels(std::move(image.rgb), image.height, image.width);
}

} // namespace

CameraChoice read_camera(nb::handle given) {
    if (nb::isinstance<nb::str>(given))
        return {nb::cast<std::string>(given), std::nullopt};
    Camera camera;
    camera.position = nb::cast<std::array<double, 3>>(given["position"]);
    camera.right = nb::cast<std::array<double, 3>>(given["right"]);
    camera.up = nb::cast<std::array<double, 3>>(given["up"]);
    camera.backward = nb::cast<std::array<double, 3>>(given["backward"]);
    camera.yfov = nb::cast<double>(given["yfov"]);
    return {{}, camera};
}

void bind_estimate(nb::module_& module) {
    module.def("estimate_irradiance", &estimate, nb::arg("device"), nb::arg("photons"), nb::arg("points"),
               nb::arg("normals"), nb::arg("k"), nb::arg("kernel"), nb::arg("progress").none() = nb::none(),
               "Irradiance (n, 3) in W/m² at points with unit normals.");
    module.def("render_image", &render, nb::arg("device"), nb::arg("scene"), nb::arg("photons").none(),
               nb::arg("settings"), nb::arg("progress").none() = nb::none(),
               "Linear radiance (height, width, 3); settings: camera, width, height, samples, mode, k, kernel, seed.");
}

} // namespace photonloupe::bindings
