// SPDX-License-Identifier: Apache-2.0
// Binds engine/estimate: irradiance at points, and rendering.
#include "binding.h"

#include "photons/map_columns.h"
#include "settings.h"

namespace photonloupe::bindings {
namespace {

nb::ndarray<nb::numpy, float> estimate(OpenDevice& open, Photons& photons, Matrix<const double, 3> points,
                                       Matrix<const float, 3> normals, const nb::dict& given, nb::object progress) {
    const std::vector<glm::vec4> local = localize_points(photons.map, {points.data(), points.size()});
    std::vector<glm::vec4> directions(normals.shape(0));
    for (std::size_t i = 0; i < directions.size(); ++i)
        directions[i] = {normals(i, 0), normals(i, 1), normals(i, 2), 0.0f};
    const auto settings = read_settings<EstimateSettings>(given);
    std::vector<float> rgb = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return read_vectors(open.workbench.estimate_irradiance(photons, local, directions, settings, asked),
                            local.size());
    });
    return own_array(std::move(rgb), 3);
}

nb::ndarray<nb::numpy, float> estimate_fluence(OpenDevice& open, Photons& photons, const Scene& scene,
                                               Matrix<const double, 3> points, const nb::dict& given,
                                               nb::object progress) {
    const std::vector<glm::vec4> local = localize_points(photons.map, {points.data(), points.size()});
    const auto settings = read_settings<EstimateSettings>(given);
    std::vector<float> rgb = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return read_vectors(open.workbench.estimate_fluence(photons, scene, local, settings, asked), local.size());
    });
    return own_array(std::move(rgb), 3);
}

nb::ndarray<nb::numpy, float, nb::ndim<3>> render(OpenDevice& open, const Scene& scene, nb::object photons,
                                                  const nb::dict& given, nb::object progress) {
    const auto settings = read_settings<RenderSettings>(given);
    const CameraChoice camera = read_camera(given["camera"]);
    Photons* map = photons.is_none() ? nullptr : nb::cast<Photons*>(photons);
    Image image = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return open.workbench.render(scene, map, camera, settings, asked);
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
    module.def(
        "aim_camera",
        [](const std::array<double, 3>& position, const std::array<double, 3>& target, const std::array<double, 3>& up,
           double yfov) {
            const Camera camera = aim_camera(position, target, up, yfov);
            return make_row("position"_a = camera.position, "right"_a = camera.right, "up"_a = camera.up,
                            "backward"_a = camera.backward, "yfov"_a = camera.yfov);
        },
        "position"_a, "target"_a, "up"_a, "yfov"_a, "A camera with its axes, that looks from one point at another.");
    module.def("estimate_irradiance", &estimate, "device"_a, "photons"_a, "points"_a, "normals"_a, "settings"_a,
               "progress"_a = nb::none(),
               "Irradiance (n, 3) in W/m² at points with unit normals; settings as describe_settings(\"irradiance\") "
               "has them.");
    module.def("estimate_fluence", &estimate_fluence, "device"_a, "photons"_a, "scene"_a, "points"_a, "settings"_a,
               "progress"_a = nb::none(),
               "Fluence (n, 3) in W/m² at points in media; settings as describe_settings(\"irradiance\") has them.");
    module.def("render_image", &render, "device"_a, "scene"_a, "photons"_a.none(), "settings"_a,
               "progress"_a = nb::none(),
               "Linear radiance (height, width, 3); settings as describe_settings(\"render\") has them, and camera.");
}

} // namespace photonloupe::bindings
