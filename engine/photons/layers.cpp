// SPDX-License-Identifier: Apache-2.0
// Builds the tree over parameters, finds r_q in it, and puts parameters in tree order.
#include "photons/layers.h"

#include <bit>
#include <cmath>
#include <numeric>
#include <sstream>

#include "photons/query_tree.h"

namespace photonloupe {
namespace {

constexpr const char* STAGE = "find layers";
// The tree's boxes have three axes.
constexpr std::size_t TREE_AXES = 3;

// Squares of parameters must be floats, and squares of their differences too.
constexpr float LARGEST_PARAMETER = 1e18f;
constexpr float LEAST_EXTENT = 1e-12f;

struct Extents {
    std::vector<float> lo, hi;
};

bool is_set(const float* values, std::uint32_t count) {
    return std::all_of(values, values + count, [](float value) { return !std::isnan(value); });
}

// Of the photons that are set.
Extents find_extents(const std::vector<float>& values, std::uint32_t count, std::size_t stride) {
    Extents extents{std::vector<float>(count, std::numeric_limits<float>::max()),
                    std::vector<float>(count, std::numeric_limits<float>::lowest())};
    for (std::size_t row = 0; row < values.size(); row += stride) {
        if (!is_set(&values[row], count))
            continue;
        for (std::uint32_t i = 0; i < count; ++i) {
            extents.lo[i] = std::min(extents.lo[i], values[row + i]);
            extents.hi[i] = std::max(extents.hi[i], values[row + i]);
        }
    }
    for (std::uint32_t i = 0; i < count; ++i)
        if (extents.lo[i] > extents.hi[i])
            extents.lo[i] = extents.hi[i] = 0.0f; // no photon is set
    return extents;
}

// Distances between parameters beyond these would be infinite or nothing, silently.
void check_extents(const Extents& extents) {
    std::ostringstream text;
    float widest = 0.0f;
    for (std::size_t i = 0; i < extents.lo.size(); ++i) {
        const float largest = std::max(std::abs(extents.lo[i]), std::abs(extents.hi[i]));
        if (largest > LARGEST_PARAMETER) {
            text << "parameter " << i << " reaches " << largest << ": squared distances beyond " << LARGEST_PARAMETER
                 << " do not fit 32-bit floats; scale the parameters down";
            throw Error(text.str());
        }
        widest = std::max(widest, extents.hi[i] - extents.lo[i]);
    }
    if (widest > 0.0f && widest < LEAST_EXTENT) {
        text << "all parameters lie within " << widest << ": squared distances below " << LEAST_EXTENT
             << " vanish in 32-bit floats; scale the parameters up";
        throw Error(text.str());
    }
}

// Parameters in the order of their extent, widest first.
std::vector<std::uint32_t> order_by_extent(const Extents& extents) {
    std::vector<std::uint32_t> order(extents.lo.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return extents.hi[a] - extents.lo[a] > extents.hi[b] - extents.lo[b];
    });
    return order;
}

} // namespace

ParameterColumns make_parameters(gpu::Device& device, std::span<const float> values, std::vector<ParameterAxis> axes) {
    const auto count = static_cast<std::uint32_t>(axes.size());
    ParameterColumns columns{count, {}, {}, std::move(axes)};
    for (const ParameterAxis& axis : columns.axes)
        columns.periods.push_back(axis.period);
    const std::size_t photons = values.size() / count, rows = columns.count_rows();
    std::vector<glm::vec4> packed(photons * rows, glm::vec4(0.0f));
    for (std::size_t photon = 0; photon < photons; ++photon) {
        const float* row = &values[photon * count];
        const bool has_values = is_set(row, count);
        for (std::uint32_t i = 0; i < count; ++i)
            packed[photon * rows + i / 4][i % 4] = has_values ? row[i] : std::numeric_limits<float>::quiet_NaN();
    }
    columns.values = gpu::make_buffer(device, packed, "parameters");
    return columns;
}

float measure_parameters(std::uint32_t count, std::span<const float> periods, std::span<const glm::vec4> a,
                         std::span<const glm::vec4> b) {
    float sum = 0.0f;
    for (std::uint32_t i = 0; i < count; ++i) {
        float d = a[i / 4][i % 4] - b[i / 4][i % 4];
        if (periods[i] > 0.0f)
            d = d - periods[i] * std::nearbyint(d * (1.0f / periods[i]));
        sum = sum + d * d;
    }
    return sum;
}

const ParameterColumns& require_parameters(const PhotonMap& photons) {
    if (!photons.parameters)
        throw Error("this map has no parameters; set them with set_parameters() or a script");
    return *photons.parameters;
}

ParameterTree build_parameter_tree(gpu::Device& device, const PhotonMap& photons, const Progress& progress) {
    const ParameterColumns& columns = require_parameters(photons);
    const std::size_t stride = 4 * columns.count_rows();
    const std::vector<float> values = columns.values.read<float>(photons.count * stride);
    const Extents extents = find_extents(values, columns.count, stride);
    check_extents(extents);
    const std::vector<std::uint32_t> order = order_by_extent(extents);
    const std::size_t axis_count = std::min<std::size_t>(TREE_AXES, columns.count);
    const std::vector<glm::vec4> positions = photons.position_emitter.read<glm::vec4>(photons.count);
    std::vector<glm::vec4> widest(photons.count);
    for (std::size_t i = 0; i < widest.size(); ++i) {
        const bool has_values = is_set(&values[i * stride], columns.count);
        for (std::size_t axis = 0; axis < axis_count; ++axis)
            widest[i][axis] = has_values ? values[i * stride + order[axis]] : extents.lo[order[axis]];
        widest[i].w = positions[i].w;
    }
    PhotonMap stand_in;
    stand_in.count = photons.count;
    stand_in.position_emitter = gpu::make_buffer(device, widest, "parameters");
    stand_in.normal_index = gpu::make_buffer(device, std::vector<glm::vec4>(photons.count), "parameters");
    ParameterTree parameter_tree;
    parameter_tree.axes.assign(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(axis_count));
    parameter_tree.tree = build_tree(device, stand_in, progress);
    double limit2 = 0;
    for (std::uint32_t i = 0; i < columns.count; ++i)
        limit2 += std::pow(static_cast<double>(extents.hi[i]) - extents.lo[i], 2);
    parameter_tree.limit2 = static_cast<float>(std::min(limit2 * 1.001 + 1e-30, 1e38));
    for (std::size_t axis = 0; axis < axis_count; ++axis)
        parameter_tree.shape.period[axis] = columns.periods[order[axis]];
    add_parameters(parameter_tree.shape, photons);
    parameter_tree.parameters = order_parameters(device, photons, parameter_tree.tree, {}, 1.0f, progress).parameters;
    parameter_tree.periods = gpu::make_buffer(device, columns.periods, "parameter periods");
    return parameter_tree;
}

void add_parameters(GatherShape& shape, const PhotonMap& photons) {
    const ParameterColumns& columns = require_parameters(photons);
    shape.parameter_count = columns.count;
    shape.has_periodic_parameters = columns.is_periodic();
}

Layers order_parameters(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const gpu::Buffer& radii2,
                        float beta, const Progress& progress) {
    const ParameterColumns& columns = require_parameters(photons);
    Layers layers{gpu::Buffer(device, columns.values.size_bytes(), "parameters in tree order"),
                  gpu::Buffer(device, std::max<std::uint64_t>(photons.count, 1) * sizeof(float), "reach of layers"),
                  gpu::make_buffer(device, columns.periods, "parameter periods")};
    struct Push {
        std::uint32_t first, count;
        float beta;
        std::uint32_t pad;
    };
    gpu::run_in_chunks(
        device, STAGE, photons.count, 1 << 14, progress,
        [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
            const Push push{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), beta, 0};
            commands.dispatch({"photons/gather_parameters.comp",
                               64,
                               {"PARAMETER_ROWS " + std::to_string(columns.count_rows()) + "u"},
                               {}},
                              {{"tree_positions", tree.positions},
                               {"parameter_values", columns.values},
                               {"parameter_radii2", radii2.is_empty() ? layers.reach2 : radii2},
                               {"tree_parameters", layers.parameters},
                               {"parameter_reach", layers.reach2}},
                              push, count);
        });
    return layers;
}

gpu::Buffer find_parameter_radii2(gpu::Device& device, const PhotonMap& photons, const ParameterTree& parameter_tree,
                                  std::uint32_t k, const Progress& progress) {
    require_k(k);
    gpu::Buffer radii2(device, std::max<std::uint64_t>(photons.count, 1) * sizeof(float), "radii in parameter space");
    shared::GatherSettings settings = make_gather_settings(parameter_tree.tree, parameter_tree.shape, k - 1);
    settings.flatness = parameter_tree.limit2;
    run_gather(
        device, parameter_tree.tree, "photons/find_parameter_radius.comp",
        list_gather_defines(parameter_tree.shape, k - 1), settings, STAGE,
        [&](gpu::Commands& commands, const gpu::KernelSource& kernel, const shared::GatherSettings& push,
            const GatherBuffers& buffers, std::uint64_t invocations) {
            commands.dispatch(kernel,
                              {{"tree_nodes", parameter_tree.tree.nodes},
                               {"tree_positions", parameter_tree.tree.positions},
                               {"tree_normals", parameter_tree.tree.normals},
                               {"tree_parameters", parameter_tree.parameters},
                               {"parameter_periods", parameter_tree.periods},
                               {"parameter_radii2", radii2},
                               {"singles", buffers.singles},
                               {"unanswered", buffers.unanswered}},
                              push, invocations);
        },
        progress);
    return radii2;
}

Layers find_layers(gpu::Device& device, const PhotonMap& photons, const ParameterTree& parameter_tree,
                   const KdTree& tree, std::uint32_t k, float beta, const Progress& progress) {
    const gpu::Buffer radii2 = find_parameter_radii2(device, photons, parameter_tree, k, progress);
    return order_parameters(device, photons, tree, radii2, beta, progress);
}

} // namespace photonloupe
