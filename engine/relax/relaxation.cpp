// SPDX-License-Identifier: Apache-2.0
// Drives a relaxation: repel, move, refit, step after step.
#include "relax/relaxation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "relax/flux_diffusion.h"

namespace photonloupe {
namespace {

constexpr const char* STAGE = "relax photons";
constexpr std::uint32_t GROUP = 64;
constexpr std::uint64_t FIRST_CHUNK = 1 << 14; // photons

// Squared radius of K neighbours as a share of that of `other` neighbours, on even density.
float scale_radius2(std::uint32_t k, std::uint32_t other) {
    return static_cast<float>(k + 1) / static_cast<float>(other + 1);
}

// METHODS (2): over-relaxation fades over the steps.
float find_tau(const RelaxSettings& settings, std::uint32_t step) {
    const double s = static_cast<double>(step) / settings.steps;
    const auto [most, least] = settings.over_relaxation;
    return static_cast<float>(least + (most - least) * std::exp(-6.0 * s * s));
}

gpu::Buffer make_filled(gpu::Device& device, std::uint64_t bytes, const char* purpose) {
    gpu::Buffer buffer(device, bytes, purpose);
    gpu::Commands commands(device, STAGE);
    commands.fill(buffer, 0);
    commands.run();
    return buffer;
}

// What floats can tell apart at the largest coordinate of the map.
float find_spacing(const KdTree& tree) {
    const shared::TreeNode root = tree.nodes.read<shared::TreeNode>(1, 1)[0];
    float largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::abs(root.lo_split[axis]), std::abs(root.hi_axis[axis])});
    return std::max(largest * 2.0f * std::numeric_limits<float>::epsilon(), 1e-15f);
}

} // namespace

Relaxation::Relaxation(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const LayerTrees& trees,
                       const RelaxSettings& settings, RelaxSurface surface, const Progress& progress)
    : m_device(device), m_photons(photons), m_settings(settings), m_surface(std::move(surface)),
      m_tree(copy_tree(device, trees.layered ? trees.layered->tree : tree)) {
    const std::uint64_t count = photons.count;
    if (count == 0)
        return;
    if (m_surface.scene)
        shift_photons();
    m_start = gpu::Buffer(device, count * sizeof(glm::vec4), "photons before relaxation");
    m_next = gpu::Buffer(device, count * sizeof(glm::vec4), "photons after a step");
    m_moves = make_filled(device, count * sizeof(glm::vec4), "moves");
    m_radii = make_filled(device, count * sizeof(float), "radii");
    gpu::Commands commands(device, STAGE);
    commands.copy(m_tree.positions, 0, m_start, 0, count * sizeof(glm::vec4));
    commands.run();

    GatherShape shape;
    shape.period = settings.period;
    shape.flat_axes = find_flat_axes(m_tree);
    m_spacing = find_spacing(m_tree);
    const ConstraintSettings& constraint = settings.constraint;
    const auto find_layers_of = [&](Space space, std::uint32_t k, float beta, GatherShape& layered) {
        if (space == Space::world)
            return Layers{};
        add_parameters(layered, photons);
        Layers layers = find_layers(device, photons, *trees.parameters, m_tree, k, beta, progress);
        if (trees.layered) {
            layers.ranges = &trees.layered->ranges;
            layered.range_axes = list_range_axes(photons, *trees.parameters);
        }
        return layers;
    };
    GatherShape constraint_shape = shape;
    if (constraint.descriptor != Descriptor::none) {
        const Layers layers = find_layers_of(constraint.space, constraint.neighbors, constraint.beta, constraint_shape);
        m_constraint = measure_constraint(device, m_tree, constraint_shape, layers, constraint, m_radii, progress);
        m_carry = scale_radius2(settings.neighbors, constraint.neighbors);
    }
    m_shape = shape;
    m_layered = trees.layered;
    m_parameter_rows = photons.parameters ? photons.parameters->count_rows() : 0;
    m_layers = find_layers_of(settings.repel, settings.neighbors, settings.beta, m_shape);
    if (settings.diffuse_flux)
        order_power();
}

void Relaxation::order_power() {
    const std::vector<glm::vec4> power = m_photons.power_object.read<glm::vec4>(m_photons.count);
    std::vector<glm::vec4> ordered;
    for (const glm::vec4& position : m_tree.positions.read<glm::vec4>(m_photons.count))
        ordered.emplace_back(glm::vec3(power[std::bit_cast<std::uint32_t>(position.w)]), 0.0f);
    m_power = gpu::make_buffer(m_device, ordered, "fluxes in tree order");
}

// The scene's triangles are relative to its origin; a map from arrays may have another.
void Relaxation::shift_photons() {
    for (std::size_t axis = 0; axis < 3; ++axis)
        m_shift[axis] = m_photons.origin[axis] - m_surface.origin[axis];
    if (m_shift == std::array<double, 3>{})
        return;
    std::vector<glm::vec4> positions = m_tree.positions.read<glm::vec4>(m_photons.count);
    for (glm::vec4& position : positions)
        for (std::size_t axis = 0; axis < 3; ++axis)
            position[axis] = static_cast<float>(position[axis] + m_shift[axis]);
    m_tree.positions.upload(positions.data(), positions.size() * sizeof(glm::vec4));
    refit_tree(m_device, m_tree, STAGE);
}

void Relaxation::find_surface(const Progress& progress) {
    m_triangles = gpu::Buffer(m_device, m_photons.count * sizeof(std::uint32_t), "photons' triangles");
    gpu::run_in_chunks(
        m_device, STAGE, m_photons.count, FIRST_CHUNK, progress,
        [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
            const shared::MoveSettings push{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), 0, 0};
            commands.dispatch({"relax/find_surface.comp", GROUP, {}, {}},
                              {{"tree_positions", m_tree.positions},
                               {"tree_normals", m_tree.normals},
                               {"power_object", m_photons.power_object},
                               {"radii", m_radii},
                               {"geometry", m_surface.scene->geometry},
                               {"photon_triangles", m_triangles}},
                              push, count);
        });
}

void Relaxation::repel(float tau, const Progress& progress) {
    const float limiter =
        m_settings.limit > 0 ? std::numbers::ln2_v<float> / (m_settings.limit * m_settings.limit) : 0.0f;
    shared::RepelSettings push{make_gather_settings(m_tree, m_shape, m_settings.neighbors), tau, limiter, m_spacing, 0};
    push.gather.carry = m_carry;
    std::vector<std::string> defines = list_gather_defines(m_shape, m_settings.neighbors);
    if (m_settings.search == RadiusSearch::carried && m_step > 0) // the first step seeks its radii
        defines.emplace_back("CARRIED");
    const bool is_constrained = m_settings.constraint.descriptor != Descriptor::none;
    if (is_constrained)
        defines.emplace_back("CONSTRAINED");
    const gpu::Buffer& unused = m_moves;
    const GatherDispatch dispatch = [&](gpu::Commands& commands, const gpu::KernelSource& kernel,
                                        const shared::GatherSettings& chunk, const GatherBuffers& buffers,
                                        std::uint64_t invocations) {
        push.gather = chunk;
        commands.dispatch(kernel,
                          {{"tree_nodes", m_tree.nodes},
                           {"tree_positions", m_tree.positions},
                           {"tree_normals", m_tree.normals},
                           {"tree_parameters", m_layers.parameters.is_empty() ? m_tree.positions : m_layers.parameters},
                           {"tree_ranges", m_layers.ranges ? *m_layers.ranges : m_tree.positions},
                           {"parameter_reach", m_layers.reach2.is_empty() ? m_radii : m_layers.reach2},
                           {"parameter_periods", m_layers.periods.is_empty() ? m_radii : m_layers.periods},
                           {"constraint_along", is_constrained ? m_constraint.along : unused},
                           {"constraint_across", is_constrained ? m_constraint.across : unused},
                           {"radii", m_radii},
                           {"moves", m_moves},
                           {"singles", buffers.singles},
                           {"unanswered", buffers.unanswered}},
                          push, invocations);
    };
    const char* kernel = "relax/repel_photons.comp";
    m_carry = 1.0f;
    const shared::GatherSettings gather = push.gather;
    if (try_gather(m_device, m_tree, kernel, defines, gather, STAGE, dispatch, progress))
        return;
    // Photons that flew far stretch the boxes they stand in: the tree is built anew about where they are now.
    reorder(progress);
    std::erase_if(defines, [](const std::string& define) { return define.starts_with("TREE_RANGES"); });
    run_gather(m_device, m_tree, kernel, defines, gather, STAGE, dispatch, progress);
}

// Builds the tree anew and brings all that is kept in its order along.
void Relaxation::reorder(const Progress& progress) {
    const std::uint64_t count = m_photons.count;
    PhotonMap present;
    present.count = count;
    present.position_emitter = gpu::make_buffer(m_device, m_tree.positions.read<glm::vec4>(count), "photon positions");
    present.normal_index = gpu::make_buffer(m_device, m_tree.normals.read<glm::vec4>(count), "photon normals");
    const std::vector<glm::vec4> old = m_tree.positions.read<glm::vec4>(count);
    KdTree tree = build_tree(m_device, present, progress);
    std::vector<glm::vec4> positions = tree.positions.read<glm::vec4>(count);
    std::vector<std::uint32_t> from(count); // the old place of each photon
    for (std::size_t at = 0; at < count; ++at) {
        from[at] = std::bit_cast<std::uint32_t>(positions[at].w);
        positions[at].w = old[from[at]].w;
    }
    tree.positions.upload(positions.data(), count * sizeof(glm::vec4));
    const auto bring = [&]<class T>(gpu::Buffer& buffer, std::size_t width, T) {
        if (buffer.is_empty())
            return;
        const std::vector<T> rows = buffer.read<T>(count * width);
        std::vector<T> brought(count * width);
        for (std::size_t at = 0; at < count; ++at)
            std::copy_n(&rows[from[at] * width], width, &brought[at * width]);
        buffer.upload(brought.data(), brought.size() * sizeof(T));
    };
    bring(m_tree.normals, 1, glm::vec4());
    std::swap(tree.normals, m_tree.normals);
    m_tree = std::move(tree);
    for (gpu::Buffer* rows : {&m_start, &m_moves, &m_constraint.along, &m_constraint.across, &m_constraint.offsets,
                              &m_constraint.member_radii, &m_power})
        bring(*rows, 1, glm::vec4());
    bring(m_radii, 1, float());
    bring(m_triangles, 1, std::uint32_t());
    bring(m_layers.reach2, 1, float());
    m_layers.ranges = nullptr; // of the nodes there were
    m_shape.range_axes.clear();
    bring(m_layers.parameters, m_parameter_rows, glm::vec4());
}

void Relaxation::move(const Progress& progress) {
    std::vector<std::string> defines;
    const SceneBuffers* scene = m_surface.scene.get();
    if (scene)
        defines.emplace_back("HAS_SURFACE");
    const bool is_constrained = m_settings.constraint.descriptor != Descriptor::none;
    const gpu::Buffer& unused = m_next;
    gpu::run_in_chunks(
        m_device, STAGE, m_photons.count, FIRST_CHUNK, progress,
        [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
            const shared::MoveSettings push{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), 0, 0};
            commands.dispatch({"relax/move_photons.comp", GROUP, defines, {}},
                              {{"tree_positions_before", m_tree.positions},
                               {"tree_positions_after", m_next},
                               {"moves", m_moves},
                               {"power_object", m_photons.power_object},
                               {"geometry", scene ? scene->geometry : m_tree.nodes},
                               {"shading_normals", scene ? scene->normals : m_tree.nodes},
                               {"tree_normals", m_tree.normals},
                               {"photon_triangles", scene ? m_triangles : m_radii},
                               {"constraint_along", is_constrained ? m_constraint.along : unused},
                               {"constraint_across", is_constrained ? m_constraint.across : unused}},
                              push, count);
        });
    std::swap(m_tree.positions, m_next);
    refit_tree(m_device, m_tree, STAGE);
}

StepReport Relaxation::step(const Progress& progress) {
    const float tau = find_tau(m_settings, m_step);
    double flux_drift = 0;
    if (m_photons.count > 0) {
        repel(tau, progress);
        if (m_settings.diffuse_flux) // before the move: radii and places belong together
            flux_drift = diffuse_flux(m_device, m_tree, m_shape, m_layers, m_radii, m_power, progress);
        if (m_surface.scene && m_triangles.is_empty()) // now that radii say how near a surface must be
            find_surface(progress);
        move(progress);
    }
    StepReport report = report_step(tau);
    report.flux_drift = flux_drift;
    ++m_step;
    return report;
}

StepReport Relaxation::report_step(float tau) {
    StepReport report;
    report.step = m_step;
    report.tau = tau;
    const std::uint64_t count = m_photons.count;
    if (count == 0)
        return report;
    const std::uint64_t runs = (count + shared::SUM_RUN - 1) / shared::SUM_RUN;
    const gpu::Buffer sums(m_device, runs * sizeof(glm::vec4), "sums of moves");
    gpu::Commands commands(m_device, STAGE);
    const shared::MoveSettings push{0, static_cast<std::uint32_t>(runs), static_cast<std::uint32_t>(count), 0};
    commands.dispatch({"relax/sum_moves.comp", GROUP, {}, {}},
                      {{"moves", m_moves}, {"radii", m_radii}, {"move_sums", sums}}, push, runs);
    commands.run();
    for (const glm::vec4& sum : sums.read<glm::vec4>(runs)) {
        report.mean_move += sum.x;
        report.largest_move = std::max(report.largest_move, static_cast<double>(sum.y));
        report.mean_pressure += sum.z;
        report.mean_metres += sum.w;
    }
    report.mean_move /= static_cast<double>(count);
    report.mean_pressure /= static_cast<double>(count);
    report.mean_metres /= static_cast<double>(count);
    return report;
}

namespace {

// One packed column by photon id, from tree order.
template <class T, class Take>
std::vector<T> scatter(const std::vector<glm::vec4>& order, std::size_t width, const Take& take) {
    std::vector<T> values(order.size() * width);
    for (std::size_t position = 0; position < order.size(); ++position)
        take(position, &values[std::bit_cast<std::uint32_t>(order[position].w) * width]);
    return values;
}

} // namespace

RelaxedColumns Relaxation::read() const {
    RelaxedColumns columns;
    const std::uint64_t count = m_photons.count;
    columns.map.count = count;
    columns.map.origin = m_photons.origin;
    const std::vector<glm::vec4> positions = m_tree.positions.read<glm::vec4>(count);
    const std::vector<glm::vec4> normals = m_tree.normals.read<glm::vec4>(count);
    const std::vector<glm::vec4> start = count ? m_start.read<glm::vec4>(count) : std::vector<glm::vec4>{};
    const std::vector<glm::vec4> before = m_photons.position_emitter.read<glm::vec4>(count);
    std::vector<glm::vec4> old_normals = m_photons.normal_index.read<glm::vec4>(count);
    std::vector<glm::vec4> power = m_photons.power_object.read<glm::vec4>(count);
    std::vector<glm::vec4> placed(count);
    const std::vector<glm::vec4> fluxes =
        m_power.is_empty() ? std::vector<glm::vec4>{} : m_power.read<glm::vec4>(count);
    columns.state.drift.resize(3 * count);
    for (std::size_t at = 0; at < count; ++at) {
        const std::uint32_t id = std::bit_cast<std::uint32_t>(positions[at].w);
        for (int axis = 0; axis < 3; ++axis) {
            const double drift = static_cast<double>(positions[at][axis]) - start[at][axis];
            columns.state.drift[3 * id + axis] = static_cast<float>(drift);
            // What did not move keeps its bits, whatever the origins.
            placed[id][axis] =
                drift == 0.0 ? before[id][axis] : static_cast<float>(positions[at][axis] - m_shift[axis]);
            old_normals[id][axis] = normals[at][axis];
        }
        placed[id].w = before[id].w;
        for (int channel = 0; channel < 3 && !fluxes.empty(); ++channel)
            power[id][channel] = fluxes[at][channel];
    }
    columns.map.position_emitter = gpu::make_buffer(m_device, placed, "photon positions");
    columns.map.normal_index = gpu::make_buffer(m_device, old_normals, "photon normals");
    columns.map.power_object = gpu::make_buffer(m_device, power, "photon powers");
    read_state(columns, positions);
    return columns;
}

void Relaxation::read_state(RelaxedColumns& columns, const std::vector<glm::vec4>& order) const {
    const std::uint64_t count = m_photons.count;
    const std::vector<glm::vec4> moves = count ? m_moves.read<glm::vec4>(count) : std::vector<glm::vec4>{};
    columns.state.pressure = scatter<float>(order, 1, [&](std::size_t at, float* value) { *value = moves[at].w; });
    if (!m_triangles.is_empty())
        for (const std::uint32_t triangle : m_triangles.read<std::uint32_t>(count))
            columns.off_surface_count += triangle == shared::NO_TRIANGLE;
    columns.has_constraint = m_settings.constraint.descriptor != Descriptor::none;
    if (!columns.has_constraint || count == 0)
        return;
    const std::vector<glm::vec4> along = m_constraint.along.read<glm::vec4>(count);
    const std::vector<glm::vec4> across = m_constraint.across.read<glm::vec4>(count);
    const std::vector<glm::vec4> offsets = m_constraint.offsets.read<glm::vec4>(count);
    const std::vector<glm::vec4> radii = m_constraint.member_radii.read<glm::vec4>(count);
    columns.state.basis = scatter<float>(order, 6, [&](std::size_t at, float* value) {
        std::copy_n(&along[at].x, 3, value);
        std::copy_n(&across[at].x, 3, value + 3);
    });
    columns.state.weights = scatter<float>(order, 2, [&](std::size_t at, float* value) {
        value[0] = along[at].w;
        value[1] = across[at].w;
    });
    columns.state.gradient = scatter<float>(order, 3, [&](std::size_t at, float* value) {
        const float r = std::sqrt(radii[at].x);
        for (int axis = 0; axis < 3; ++axis)
            value[axis] = r > 0 ? 4.0f * offsets[at][axis] / r : 0.0f; // METHODS §5.1: 4m/r²
    });
    columns.state.one_sidedness = scatter<float>(order, 1, [&](std::size_t at, float* value) { *value = radii[at].z; });
}

} // namespace photonloupe
