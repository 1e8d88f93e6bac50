// SPDX-License-Identifier: Apache-2.0
// Drives a relaxation: repel, move, refit, step after step.
#include "relax/relaxation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <sstream>

#include "photons/find_neighbors.h"
#include "photons/tree_kernels.h"
#include "relax/flux_diffusion.h"

namespace photonloupe {
namespace {

constexpr const char* STAGE = "relax photons";
constexpr std::uint32_t GROUP = 64;
constexpr std::uint64_t FIRST_CHUNK = 1 << 14; // photons
// Radii that a photon may go before the tree is built anew: its leaf is about as wide as a few of them.
constexpr double LONGEST_TRAVEL = 4.0;
// Of the photons; with so many layers that reach everywhere the user is told.
constexpr double BOUNDLESS_SHARE = 0.5;

// Squared radius of K neighbours as a share of that of `other` neighbours, on even density.
float scale_radius2(std::uint32_t k, std::uint32_t other) {
    return static_cast<float>(k + 1) / static_cast<float>(other + 1);
}

// METHODS (2): over-relaxation fades over the steps.
float find_tau(const RelaxSettings& settings, std::uint32_t step) {
    const double s = static_cast<double>(step) / std::max(*settings.steps, 1u);
    const auto [most, least] = settings.over_relaxation;
    return static_cast<float>(least + (most - least) * std::exp(-6.0 * s * s));
}

gpu::KernelSource name_surface_kernel() {
    return {"relax/find_surface.comp", GROUP, {}, {}};
}

gpu::KernelSource name_sum_kernel() {
    return {"relax/sum_moves.comp", GROUP, {}, {}};
}

gpu::Buffer make_filled(gpu::Device& device, std::uint64_t bytes, const char* purpose) {
    gpu::Buffer buffer(device, bytes, purpose);
    gpu::fill(device, STAGE, buffer, 0);
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

// Brings columns from the order of one tree (`before`: its photons) into that of another.
template <class T>
void bring(const std::vector<glm::vec4>& before, const KdTree& tree, std::initializer_list<gpu::Buffer*> columns) {
    std::vector<std::uint32_t> place(before.size()); // by photon id
    for (std::uint32_t at = 0; at < before.size(); ++at)
        place[std::bit_cast<std::uint32_t>(before[at].w)] = at;
    const std::vector<glm::vec4> now = tree.positions.read<glm::vec4>(before.size());
    for (gpu::Buffer* column : columns) {
        if (column->is_empty())
            continue;
        const std::vector<T> rows = column->read<T>(before.size());
        std::vector<T> brought(before.size());
        for (std::size_t at = 0; at < now.size(); ++at)
            brought[at] = rows[place[std::bit_cast<std::uint32_t>(now[at].w)]];
        column->upload(brought.data(), brought.size() * sizeof(T));
    }
}

} // namespace

Relaxation::Relaxation(gpu::Device& device, const PhotonMap& photons, const RelaxTrees& trees,
                       const CompleteSettings& complete, RelaxSurface surface, const Progress& progress)
    : m_device(device), m_photons(photons), m_settings(complete.settings), m_surface(std::move(surface)),
      m_tree(
          copy_tree(device, complete.settings.repel == Space::parameter ? trees.layered->tree : *trees.by_positions)) {
    const std::uint64_t count = photons.count;
    if (count == 0)
        return;
    m_moves = make_filled(device, count * sizeof(glm::vec4), "moves");
    m_radii = make_filled(device, count * RADIUS_BYTES, "radii");
    m_flat_axes = find_flat_axes(m_tree);
    if (m_settings.repel == Space::parameter) {
        m_parameters = trees.layered->parameters;
        m_parameter_scale = trees.layered->parameter_scale;
    }
    m_device.compile_ahead(list_kernels());
    constrain(trees, progress);
    take_layers(trees, progress);
    m_notes.insert(m_notes.begin(), complete.notes.begin(), complete.notes.end());
    if (m_surface.scene)
        shift_photons();
    m_start = gpu::Buffer(device, count * sizeof(glm::vec4), "photons before relaxation");
    m_next = gpu::Buffer(device, count * sizeof(glm::vec4), "photons after a step");
    gpu::copy(device, STAGE, m_tree.positions, m_start, count * sizeof(glm::vec4));
    m_spacing = find_spacing(m_tree);
    if (m_settings.diffuse_flux)
        order_power();
}

// Measures the constraint in the tree that suits it and brings it into the order of the photons' own.
void Relaxation::constrain(const RelaxTrees& trees, const Progress& progress) {
    if (!m_settings.constrains())
        return;
    const std::uint32_t k = *m_settings.constraint_neighbors;
    m_carry = scale_radius2(m_settings.neighbors, k);
    if (m_settings.constraint == Space::world) {
        Neighborhood world{m_tree, Measure::surface};
        world.period = find_period();
        world.flat_axes = m_flat_axes;
        m_constraint = measure_constraint(m_device, world, ask_photons(m_tree), m_settings, m_radii, progress);
        return;
    }
    const ParameterTree& layered = *trees.layered;
    m_notes = layered.parameters->notes;
    const gpu::Buffer reach2 =
        find_layer_reaches(m_device, *trees.by_parameters, layered.tree, k, find_beta(), progress);
    note_reaches(layered, reach2, "constraint");
    Neighborhood layers = look_in(layered, Measure::surface);
    layers.is_layered = true;
    layers.period = find_period();
    layers.flat_axes = m_flat_axes;
    m_constraint =
        measure_constraint(m_device, layers, ask_photons(layered.tree, &reach2), m_settings, m_radii, progress);
    if (m_settings.repel == Space::world)
        bring<glm::vec4>(
            layered.tree.positions.read<glm::vec4>(m_photons.count), m_tree,
            {&m_constraint.along, &m_constraint.across, &m_constraint.offsets, &m_constraint.member_radii, &m_radii});
}

void Relaxation::take_layers(const RelaxTrees& trees, const Progress& progress) {
    if (m_settings.repel == Space::world)
        return;
    m_reach2 = find_layer_reaches(m_device, *trees.by_parameters, m_tree, m_settings.neighbors, find_beta(), progress);
    if (m_notes.empty()) {
        m_notes = m_parameters->notes;
        note_reaches(*trees.layered, m_reach2, "repulsion");
    }
}

void Relaxation::note_reaches(const ParameterTree& tree, const gpu::Buffer& reaches2, const char* of) {
    const double share = measure_boundless_share(tree, reaches2.read<float>(m_photons.count));
    if (share < BOUNDLESS_SHARE || !tree.parameters->notes.empty())
        return;
    std::ostringstream text;
    text << "the layers of the " << of << " reach over all of parameter space for " << std::round(100.0 * share)
         << " % of the photons at beta " << find_beta()
         << ": they keep nothing apart, as in world space; take a smaller beta "
         << "or fewer neighbors";
    m_notes.push_back(text.str());
}

float Relaxation::find_beta() const {
    return static_cast<float>(m_settings.beta.value_or(0.0));
}

std::array<float, 3> Relaxation::find_period() const {
    std::array<float, 3> period;
    std::copy(m_settings.period.begin(), m_settings.period.end(), period.begin());
    return period;
}

// What the photons look for in each step, where they are now.
Neighborhood Relaxation::look() const {
    Neighborhood neighborhood =
        m_parameters ? look_in(m_tree, *m_parameters, Measure::surface) : Neighborhood{m_tree, Measure::surface};
    neighborhood.is_layered = m_parameters != nullptr;
    neighborhood.period = find_period();
    neighborhood.flat_axes = m_flat_axes;
    return neighborhood;
}

Queries Relaxation::ask() const {
    return ask_photons(m_tree, m_parameters ? &m_reach2 : nullptr);
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
    gpu::dispatch_in_chunks(m_device, STAGE, name_surface_kernel(),
                            {{"tree_positions", m_tree.positions},
                             {"tree_normals", m_tree.normals},
                             {"power_object", m_photons.power_object},
                             {"radii", m_radii},
                             {"geometry", m_surface.scene->geometry},
                             {"photon_triangles", m_triangles}},
                            shared::MoveSettings{0, 0, 0, 0}, m_photons.count, FIRST_CHUNK, progress);
}

// Of a step; the first seeks its radii.
RadiusSettings Relaxation::choose_radius(std::uint32_t step) const {
    RadiusSettings radius{rank_for(m_settings.neighbors)};
    radius.carry = m_carry;
    radius.is_carried = m_settings.search == RadiusSearch::carried && step > 0;
    return radius;
}

GatherKernel Relaxation::name_repulsion() const {
    GatherKernel kernel{"relax/repel_photons.comp", {}, {}};
    if (m_settings.search == RadiusSearch::carried)
        kernel.defines.emplace_back("CARRIED");
    if (m_settings.constrains())
        kernel.defines.emplace_back("CONSTRAINED");
    return kernel;
}

gpu::KernelSource Relaxation::name_move_kernel() const {
    gpu::KernelSource kernel{"relax/move_photons.comp", GROUP, {}, {}};
    if (m_surface.scene)
        kernel.defines.emplace_back("HAS_SURFACE");
    return kernel;
}

// What the steps dispatch, beside the diffusion of flux.
std::vector<gpu::KernelSource> Relaxation::list_kernels() const {
    const Neighborhood neighborhood = look();
    const Queries queries = ask();
    std::vector<gpu::KernelSource> kernels{name_radius_kernel(neighborhood, queries, choose_radius(0)),
                                           name_gather_kernel(neighborhood, queries, name_repulsion())};
    if (m_surface.scene)
        kernels.push_back(name_surface_kernel());
    kernels.push_back(name_move_kernel());
    const TreeKernels trees(0, m_device.limits().subgroup_size);
    for (const gpu::KernelSource& kernel : {trees.refit_leaves(), trees.refit_nodes(), name_sum_kernel(),
                                            name_radius_kernel(neighborhood, queries, choose_radius(1))})
        kernels.push_back(kernel);
    return kernels;
}

void Relaxation::repel(float tau, const Progress& progress) {
    const auto limit = static_cast<float>(m_settings.limit.value_or(0.0));
    const float limiter = limit > 0 ? std::numbers::ln2_v<float> / (limit * limit) : 0.0f;
    const Neighborhood neighborhood = look();
    const Queries queries = ask();
    const RadiusSettings radius = choose_radius(m_step);
    find_radii(m_device, neighborhood, queries, radius, m_radii, STAGE, progress);
    const bool is_constrained = m_settings.constrains();
    GatherKernel kernel = name_repulsion();
    for (const gpu::Binding& binding : {gpu::Binding{"constraint_along", is_constrained ? m_constraint.along : m_moves},
                                        {"constraint_across", is_constrained ? m_constraint.across : m_moves},
                                        {"radii", m_radii},
                                        {"moves", m_moves}})
        kernel.bindings.push_back(binding);
    const shared::RepelSettings push{make_gather_settings(neighborhood, radius.rank), tau, limiter, m_spacing, 0};
    gather(m_device, neighborhood, queries, kernel, push, STAGE, progress);
    m_carry = 1.0f;
}

// Photons that went far stretch the boxes they stand in: the tree is built anew about where they are now, and all that
// is kept in its order brought along.
void Relaxation::rebuild_tree(const Progress& progress) {
    const std::uint64_t count = m_photons.count;
    const std::vector<glm::vec4> before = m_tree.positions.read<glm::vec4>(count);
    const TreePhotons present(count, m_tree.positions, m_tree.normals); // ids are places in the old tree
    KdTree tree;
    if (m_parameters) {
        const RangeRows rows{m_parameters->rows.axis_count, std::move(m_tree.rows)};
        tree = build_tree(m_device, present, rows, TreeAxes::both, m_parameter_scale, progress);
    } else {
        tree = build_tree(m_device, present, progress);
    }
    std::vector<glm::vec4> positions = tree.positions.read<glm::vec4>(count);
    for (glm::vec4& position : positions)
        position.w = before[std::bit_cast<std::uint32_t>(position.w)].w;
    tree.positions.upload(positions.data(), count * sizeof(glm::vec4));
    m_tree = std::move(tree);
    bring<glm::vec4>(before, m_tree,
                     {&m_start, &m_moves, &m_radii, &m_power, &m_constraint.along, &m_constraint.across,
                      &m_constraint.offsets, &m_constraint.member_radii});
    bring<std::uint32_t>(before, m_tree, {&m_triangles, &m_reach2});
    m_travel = 0;
}

void Relaxation::move(const Progress& progress) {
    const SceneBuffers* scene = m_surface.scene.get();
    const bool is_constrained = m_settings.constrains();
    const gpu::Buffer& unused = m_next;
    gpu::dispatch_in_chunks(m_device, STAGE, name_move_kernel(),
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
                            shared::MoveSettings{0, 0, 0, 0}, m_photons.count, FIRST_CHUNK, progress);
    std::swap(m_tree.positions, m_next);
    refit_tree(m_device, m_tree, STAGE);
}

StepReport Relaxation::step(const Progress& progress) {
    const float tau = find_tau(m_settings, m_step);
    double flux_drift = 0;
    if (m_photons.count > 0) {
        if (m_travel > LONGEST_TRAVEL)
            rebuild_tree(progress);
        repel(tau, progress);
        if (m_settings.diffuse_flux) // before the move: radii and places belong together
            flux_drift = diffuse_flux(m_device, look(), ask(), m_radii, m_power, progress);
        if (m_surface.scene && m_triangles.is_empty()) // now that radii say how near a surface must be
            find_surface(progress);
        move(progress);
    }
    StepReport report = report_step(tau);
    report.flux_drift = flux_drift;
    m_travel += report.largest_move;
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
    const shared::MoveSettings push{0, static_cast<std::uint32_t>(runs), static_cast<std::uint32_t>(count), 0};
    gpu::dispatch(m_device, STAGE, name_sum_kernel(), {{"moves", m_moves}, {"radii", m_radii}, {"move_sums", sums}},
                  push, runs);
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
    if (!m_settings.constrains() || count == 0)
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

std::uint64_t Relaxation::count_off_surface() const {
    if (!m_surface.scene)
        return m_photons.count;
    if (m_triangles.is_empty())
        return 0;
    const std::vector<std::uint32_t> triangles = m_triangles.read<std::uint32_t>(m_photons.count);
    return static_cast<std::uint64_t>(std::count(triangles.begin(), triangles.end(), shared::NO_TRIANGLE));
}

std::vector<float> Relaxation::sample_distances(std::uint64_t sample_count, std::uint32_t k,
                                                const Progress& progress) const {
    sample_count = std::min(sample_count, m_photons.count);
    NeighborQueries queries;
    for (std::uint64_t i = 0; i < sample_count; ++i)
        queries.points.push_back(m_tree.positions.read<glm::vec4>(1, i * m_photons.count / sample_count)[0]);
    return find_neighbors(m_device, {m_tree}, queries, k, progress).distances.read<float>(sample_count * k);
}

} // namespace photonloupe
