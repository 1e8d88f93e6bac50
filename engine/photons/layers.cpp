// SPDX-License-Identifier: Apache-2.0
// Packs parameters into rows, builds the trees that know them, and finds r_q.
#include "photons/layers.h"

#include <bit>
#include <cmath>
#include <sstream>

namespace photonloupe {
namespace {

constexpr const char* STAGE = "find layers";
constexpr std::uint32_t GROUP = 64;

// Squares of parameters must be floats, and squares of their differences too.
constexpr float LARGEST_PARAMETER = 1e18f;
constexpr float LEAST_EXTENT = 1e-12f;
// Layer numbers are floats: above this some whole numbers are missing.
constexpr std::int32_t LARGEST_EMITTER = (1 << 24) - 2;

struct Extents {
    std::vector<float> lo, hi; // of the photons that are set
    std::size_t set_count = 0;
};

bool is_set(const float* values, std::uint32_t count) {
    return std::all_of(values, values + count, [](float value) { return !std::isnan(value); });
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

// What a user should know of parameters that tell no photons apart.
std::vector<std::string> judge_extents(const ParameterColumns& columns, const Extents& extents) {
    std::string constant;
    std::size_t constant_count = 0;
    for (std::size_t i = 0; i < columns.count; ++i)
        if (extents.lo[i] == extents.hi[i]) {
            constant += (constant_count++ ? ", '" : "'") + columns.axes[i].name + "'";
        }
    if (extents.set_count == 0)
        return {"no photon has parameters: all count as one layer, as in world space; set them, or use "
                "constraint=\"world\""};
    if (constant_count == columns.count)
        return {"the parameter" + std::string(columns.count > 1 ? "s " : " ") + constant +
                (columns.count > 1 ? " are" : " is") +
                " the same for all photons: they tell none apart, and each emitter's are one layer, as in world space; "
                "compute something that differs, or use constraint=\"world\""};
    return {};
}

std::vector<glm::vec4> pack_periods(const ParameterColumns& columns, std::uint32_t row_count) {
    std::vector<glm::vec4> periods(row_count, glm::vec4(0.0f));
    for (std::uint32_t i = 0; i < columns.count; ++i)
        periods[(i + 1) / 4][static_cast<int>((i + 1) % 4)] = columns.periods[i];
    return periods;
}

} // namespace

ParameterColumns make_parameters(gpu::Device& device, std::vector<float> values, std::vector<ParameterAxis> axes) {
    const auto count = static_cast<std::uint32_t>(axes.size());
    ParameterColumns columns{count, {}, {}, {}, std::move(axes)};
    for (const ParameterAxis& axis : columns.axes)
        columns.periods.push_back(static_cast<float>(axis.period));
    const std::size_t photons = values.size() / count, rows = columns.count_rows();
    std::vector<glm::vec4> packed(photons * rows, glm::vec4(0.0f));
    for (std::size_t photon = 0; photon < photons; ++photon) {
        const float* row = &values[photon * count];
        const bool has_values = is_set(row, count);
        for (std::uint32_t i = 0; i < count; ++i)
            packed[photon * rows + i / 4][i % 4] = has_values ? row[i] : std::numeric_limits<float>::quiet_NaN();
    }
    columns.values = gpu::make_buffer(device, packed, "parameters");
    columns.given = std::make_shared<const std::vector<float>>(std::move(values));
    return columns;
}

const ParameterColumns& require_parameters(const PhotonMap& photons) {
    if (!photons.parameters)
        throw Error("this map has no parameters; set them with set_parameters() or a script");
    return *photons.parameters;
}

float number_layer(std::int32_t emitter, bool is_set) {
    if (emitter < 0 || emitter > LARGEST_EMITTER)
        throw Error("emitter " + std::to_string(emitter) + ": photons with parameters may have emitters 0 to " +
                    std::to_string(LARGEST_EMITTER) + "; number them anew");
    return static_cast<float>(is_set ? emitter + 1 : -emitter - 1);
}

ParameterRows make_parameter_rows(gpu::Device& device, const PhotonMap& photons) {
    const ParameterColumns& columns = require_parameters(photons);
    ParameterRows made;
    made.rows.axis_count = columns.count + 1;
    made.has_periods = columns.is_periodic();
    const std::size_t stride = 4 * columns.count_rows(), row_count = made.rows.count_rows();
    const std::vector<float> values = columns.values.read<float>(photons.count * stride);
    const std::vector<glm::vec4> positions = photons.position_emitter.read<glm::vec4>(photons.count);
    std::vector<float> rows(photons.count * 4 * row_count, 0.0f);
    Extents extents{std::vector<float>(columns.count, std::numeric_limits<float>::max()),
                    std::vector<float>(columns.count, std::numeric_limits<float>::lowest())};
    for (std::size_t id = 0; id < photons.count; ++id) {
        const float* own = &values[id * stride];
        float* row = &rows[id * 4 * row_count];
        const bool has_values = is_set(own, columns.count);
        row[0] = number_layer(std::bit_cast<std::int32_t>(positions[id].w), has_values);
        extents.set_count += has_values;
        for (std::uint32_t i = 0; i < columns.count && has_values; ++i) {
            row[i + 1] = own[i];
            extents.lo[i] = std::min(extents.lo[i], own[i]);
            extents.hi[i] = std::max(extents.hi[i], own[i]);
        }
    }
    if (extents.set_count == 0)
        extents.lo = extents.hi = std::vector<float>(columns.count, 0.0f);
    check_extents(extents);
    made.notes = judge_extents(columns, extents);
    made.rows.values = gpu::make_buffer(device, rows, "parameter rows");
    made.periods = gpu::make_buffer(device, pack_periods(columns, made.rows.count_rows()), "parameter periods");
    return made;
}

ParameterTree build_parameter_tree(gpu::Device& device, const PhotonMap& photons,
                                   std::shared_ptr<const ParameterRows> parameters, const Progress& progress) {
    KdTree tree = build_tree(device, photons, parameters->rows, TreeAxes::ranges, 0, progress);
    return {std::move(parameters), std::move(tree), 0};
}

ParameterTree build_layered_tree(gpu::Device& device, const PhotonMap& photons,
                                 std::shared_ptr<const ParameterRows> parameters, float parameter_scale,
                                 const Progress& progress) {
    KdTree tree = build_tree(device, photons, parameters->rows, TreeAxes::both, parameter_scale, progress);
    return {std::move(parameters), std::move(tree), parameter_scale};
}

Neighborhood look_in(const KdTree& tree, const ParameterRows& rows, Measure measure) {
    return {.tree = tree,
            .measure = measure,
            .axis_count = rows.rows.axis_count,
            .row_periods = &rows.periods,
            .has_periods = rows.has_periods};
}

gpu::Buffer find_parameter_radii(gpu::Device& device, const ParameterTree& tree, const Queries& queries,
                                 std::uint32_t k, const Progress& progress) {
    require_k(k);
    gpu::Buffer radii(device, std::max<std::uint64_t>(queries.count, 1) * RADIUS_BYTES, "radii in parameter space");
    RadiusSettings settings{k + 1}; // and the photon itself
    settings.needs_ties = false;
    find_radii(device, look_in(tree, Measure::parameters), queries, settings, radii, STAGE, progress);
    return radii;
}

gpu::Buffer find_layer_reaches(gpu::Device& device, const ParameterTree& by_parameters, const KdTree& layered,
                               std::uint32_t k, float beta, const Progress& progress) {
    const KdTree& tree = by_parameters.tree;
    const gpu::Buffer radii = find_parameter_radii(device, by_parameters, ask_photons(tree), k, progress);
    const std::uint64_t bytes = std::max<std::uint64_t>(tree.count, 1) * sizeof(float);
    const gpu::Buffer by_id(device, bytes, "reaches of layers");
    gpu::Buffer reaches(device, bytes, "reaches of layers");
    const auto run = [&](const char* kernel, const KdTree& order, const gpu::Buffer& to) {
        gpu::dispatch_in_chunks(
            device, STAGE, {kernel, GROUP, {}, {}},
            {{"tree_positions", order.positions}, {"radii", radii}, {"reaches_by_id", by_id}, {"tree_reaches", to}},
            shared::ReachSettings{0, 0, k, beta}, tree.count, 1 << 14, progress);
    };
    run("photons/scale_reaches.comp", tree, reaches);
    run("photons/order_reaches.comp", layered, reaches);
    return reaches;
}

double measure_boundless_share(const ParameterTree& tree, std::span<const float> reaches2) {
    const std::uint32_t rows = tree.tree.range_rows;
    const std::vector<glm::vec4> box = tree.tree.ranges.read<glm::vec4>(2 * rows, 2 * rows);
    double extent2 = 0;
    for (std::uint32_t axis = 1; axis < tree.parameters->rows.axis_count; ++axis) {
        const int at = static_cast<int>(axis % 4);
        extent2 += std::pow(static_cast<double>(box[rows + axis / 4][at]) - box[axis / 4][at], 2);
    }
    const auto boundless = std::count_if(reaches2.begin(), reaches2.end(), [&](float reach2) {
        return std::isfinite(reach2) && static_cast<double>(reach2) >= extent2;
    });
    return reaches2.empty() ? 0.0 : static_cast<double>(boundless) / static_cast<double>(reaches2.size());
}

} // namespace photonloupe
