// SPDX-License-Identifier: Apache-2.0
// Binds engine/inspect: what is drawn by pixel — surfaces, cells, scatter plots, error maps.
#include "binding.h"

#include "estimate/camera_frame.h"
#include "inspect/columns/columns.h"
#include "inspect/error_map.h"
#include "inspect/kd_cells.h"
#include "inspect/photon_colors.h"
#include "inspect/scatter.h"
#include "inspect/voronoi.h"

namespace photonloupe::bindings {
namespace {

using namespace inspect;

nb::dict describe_cells(CellImage cells, Image painted) {
    return make_row("pixels"_a = own_pixels(std::move(painted.rgb), cells.height, cells.width),
                    "ids"_a = own_array(std::move(cells.ids), cells.width),
                    "depth"_a = own_array(std::move(cells.depth), cells.width),
                    "borders"_a = own_array(std::move(cells.is_border), cells.width));
}

// What of a view Python says; read before the GIL is given up.
struct ViewAsked {
    CameraChoice camera;
    SurfaceViewSettings settings;
};

ViewAsked read_view(const nb::dict& given) {
    return {read_camera(given["camera"]),
            {nb::cast<std::uint32_t>(given["width"]), nb::cast<std::uint32_t>(given["height"]),
             nb::cast<bool>(given["through_glass"])}};
}

SurfaceView see(OpenDevice& open, const Scene& scene, const ViewAsked& asked, const Progress& progress) {
    const Camera camera = find_camera(scene, asked.camera);
    return see_surfaces(open.device, scene, *open.workbench.find_buffers(scene),
                        frame_camera(scene.origin, camera, asked.settings.width, asked.settings.height), asked.settings,
                        progress);
}

nb::tuple describe_surfaces(OpenDevice& open, const Scene& scene, const nb::dict& given, nb::object progress) {
    const ViewAsked asked_view = read_view(given);
    const SurfaceView view = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return see(open, scene, asked_view, asked);
    });
    std::vector<float> points, normals;
    std::vector<std::int32_t> objects;
    for (const glm::vec4& point : view.points.read<glm::vec4>(view.pixel_count()))
        for (int axis = 0; axis < 4; ++axis)
            points.push_back(axis < 3 ? static_cast<float>(point[axis] + view.origin[axis]) : point.w);
    for (const glm::vec4& normal : view.normals.read<glm::vec4>(view.pixel_count())) {
        normals.insert(normals.end(), {normal.x, normal.y, normal.z});
        objects.push_back(std::bit_cast<std::int32_t>(normal.w));
    }
    return nb::make_tuple(own_array(std::move(points), 4), own_array(std::move(normals), 3),
                          own_array(std::move(objects)));
}

nb::dict find_voronoi(OpenDevice& open, Photons& photons, const Scene& scene, const nb::dict& given,
                      nb::object progress) {
    const auto color = nb::cast<std::string>(given["color"]);
    const VoronoiSettings settings{nb::cast<float>(given["flatness"])};
    const ViewAsked asked_view = read_view(given);
    CellImage cells;
    Image painted = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        const SurfaceView view = see(open, scene, asked_view, asked);
        cells = find_voronoi_cells(open.device, photons.map, *find_tree(open.device, photons, asked), view, settings,
                                   asked);
        return paint_cells(cells, find_photon_colors(open.device, photons, color, asked));
    });
    return describe_cells(std::move(cells), std::move(painted));
}

nb::list describe_boxes(const std::vector<NodeBox>& boxes, const std::array<double, 3>& origin) {
    return list_rows(boxes, [&](const NodeBox& box) {
        std::array<double, 6> corners{};
        for (int axis = 0; axis < 3; ++axis) {
            corners[axis] = box.low[axis] + origin[axis];
            corners[axis + 3] = box.high[axis] + origin[axis];
        }
        return nb::make_tuple(box.node, box.photon_count, corners);
    });
}

nb::dict find_kd(OpenDevice& open, Photons& photons, const Scene& scene, const nb::dict& given, nb::object progress) {
    const auto depth = nb::cast<std::optional<std::uint32_t>>(given["depth"]);
    const ViewAsked asked_view = read_view(given);
    CellImage cells;
    std::vector<NodeBox> boxes;
    Image painted = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        const SurfaceView view = see(open, scene, asked_view, asked);
        const std::shared_ptr<const KdTree> tree = find_tree(open.device, photons, asked);
        cells = find_kd_cells(open.device, photons.map, *tree, view, depth, asked);
        boxes = list_node_boxes(*tree, depth);
        return paint_cells(cells, list_hash_colors(2ull << tree->leaf_level));
    });
    nb::dict row = describe_cells(std::move(cells), std::move(painted));
    row["boxes"] = describe_boxes(boxes, photons.map.origin);
    return row;
}

using Range2 = std::optional<std::pair<double, double>>;

nb::dict plot(OpenDevice& open, Photons& photons, const nb::dict& given, std::optional<Selection> selection) {
    ScatterSettings settings;
    settings.width = nb::cast<std::uint32_t>(given["width"]);
    settings.height = nb::cast<std::uint32_t>(given["height"]);
    settings.is_polar = nb::cast<bool>(given["polar"]);
    settings.x_range = nb::cast<Range2>(given["x_range"]);
    settings.y_range = nb::cast<Range2>(given["y_range"]);
    settings.dense_from = nb::cast<std::uint32_t>(given["dense_from"]);
    const auto names = std::array{nb::cast<std::string>(given["x"]), nb::cast<std::string>(given["y"]),
                                  nb::cast<std::string>(given["color"])};
    const auto [x, y, colors] = PythonProgress(nb::none()).run([&](const Progress& asked) {
        return std::tuple(find_column(open.device, photons, names[0], asked),
                          find_column(open.device, photons, names[1], asked),
                          find_photon_colors(open.device, photons, names[2], asked));
    });
    ScatterPlot made = plot_scatter(x, y, colors, selection ? &*selection : nullptr, settings);
    std::vector<double> pixels;
    for (std::size_t i = 0; i < x.values.size(); ++i) {
        const glm::dvec2 pixel = made.frame.to_pixel(x.values[i], y.values[i]);
        pixels.insert(pixels.end(), {pixel.x, pixel.y});
    }
    const nb::object to_data = nb::cpp_function([frame = made.frame](double column, double row_down) {
        const glm::dvec2 data = frame.to_data({column, row_down});
        return std::pair(data.x, data.y);
    });
    return make_row("rgba"_a = own_array(std::move(made.rgba), 4), "pixels"_a = own_array(std::move(pixels), 2),
                    "x_label"_a = x.label, "y_label"_a = y.label, "x_range"_a = made.frame.x_range(),
                    "y_range"_a = made.frame.y_range(), "drawn"_a = made.drawn_count, "dense"_a = made.is_dense,
                    "to_data"_a = to_data);
}

nb::dict map_errors(const Pixels& a, const Pixels& b, bool is_relative, float full) {
    ErrorMap map = measure_errors(take_image(a), take_image(b));
    Image painted = paint_errors(map, is_relative, full);
    return make_row("pixels"_a = own_pixels(std::move(painted.rgb), map.height, map.width), "rmse"_a = map.rmse,
                    "relmse"_a = map.relmse, "absolute"_a = own_array(std::move(map.absolute), map.width),
                    "relative"_a = own_array(std::move(map.relative), map.width));
}

} // namespace

void bind_inspect_images(nb::module_& module) {
    module.def("see_surfaces", &describe_surfaces, "device"_a, "scene"_a, "settings"_a, "progress"_a = nb::none(),
               "(points and depth (p, 4), normals (p, 3), objects (p,)) by pixel; settings: camera, width, height, "
               "through_glass.");
    module.def("find_voronoi_cells", &find_voronoi, "device"_a, "photons"_a, "scene"_a, "settings"_a,
               "progress"_a = nb::none(),
               "ids, depth, borders (h, w), pixels (h, w, 3); settings: camera, width, height, through_glass, "
               "flatness, color.");
    module.def("find_kd_cells", &find_kd, "device"_a, "photons"_a, "scene"_a, "settings"_a, "progress"_a = nb::none(),
               "The same with nodes for ids, and boxes (node, photons, corners); settings: camera, width, height, "
               "through_glass, depth.");
    module.def("plot_scatter", &plot, "device"_a, "photons"_a, "settings"_a, "selection"_a.none(),
               "A scatter plot; settings: x, y, width, height, polar, color, x_range, y_range, dense_from.");
    module.def("map_errors", &map_errors, "image"_a, "reference"_a, "relative"_a, "full"_a,
               "Errors by pixel: pixels (h, w, 3), absolute, relative (h, w), rmse, relmse.");
}

} // namespace photonloupe::bindings
