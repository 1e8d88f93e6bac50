// SPDX-License-Identifier: Apache-2.0
// Photon relaxation, a step at a time (METHODS §3): photons repel their neighbours until they lie evenly, each as far
// as its constraint allows, and stay on the surface they lie on.
#pragma once

#include "relax/complete_settings.h"
#include "relax/constraint.h"
#include "relax/relaxed_state.h"
#include "scene/scene_buffers.h"

namespace photonloupe {

// The surface photons return to, kept as long as the relaxation; `origin` is the scene's.
struct RelaxSurface {
    std::shared_ptr<const SceneBuffers> scene;
    std::array<double, 3> origin{};
};

// What one step did.
struct StepReport {
    std::uint32_t step = 0;
    double tau = 0;           // over-relaxation (2)
    double mean_move = 0;     // of |move|/r
    double largest_move = 0;  // of |move|/r
    double mean_pressure = 0; // of |f'|/r, before constraint and limiter
    double mean_metres = 0;   // of |move|
    double flux_drift = 0;    // relative, before the total was restored
};

// What came of it, by photon id.
struct RelaxedColumns {
    PhotonMap map; // without paths
    RelaxedState state;
};

// The photons' trees; those that know parameters where constraint or repulsion look at them.
struct RelaxTrees {
    std::shared_ptr<const KdTree> by_positions;
    std::shared_ptr<const ParameterTree> by_parameters, layered;
};

class Relaxation {
public:
    // Measures the constraint. Without a surface's scene photons move in their tangent planes.
    Relaxation(gpu::Device& device, const PhotonMap& photons, const RelaxTrees& trees, const CompleteSettings& complete,
               RelaxSurface surface, const Progress& progress);

    // One step (Jacobi: all photons see the places before it).
    StepReport step(const Progress& progress);

    // What was automatic and could not be found, and what makes parameters useless here, with the cure.
    const std::vector<std::string>& notes() const { return m_notes; }
    std::uint32_t step_count() const { return m_step; }
    const RelaxSettings& settings() const { return m_settings; }
    RelaxedColumns read() const;
    // Photons that moved in their tangent plane.
    std::uint64_t count_off_surface() const;
    // Distances in metres from some photons, spread evenly over the tree, to their k nearest where they are now.
    std::vector<float> sample_distances(std::uint64_t sample_count, std::uint32_t k, const Progress& progress) const;

private:
    void find_surface(const Progress& progress);
    void shift_photons();
    void order_power();
    Neighborhood look() const;
    Queries ask() const;
    void constrain(const RelaxTrees& trees, const Progress& progress);
    void take_layers(const RelaxTrees& trees, const Progress& progress);
    void note_reaches(const ParameterTree& tree, const gpu::Buffer& reaches2, const char* of);
    float find_beta() const;
    std::array<float, 3> find_period() const;
    RadiusSettings choose_radius(std::uint32_t step) const;
    GatherKernel name_repulsion() const;
    gpu::KernelSource name_move_kernel() const;
    std::vector<gpu::KernelSource> list_kernels() const;
    void repel(float tau, const Progress& progress);
    void move(const Progress& progress);
    void rebuild_tree(const Progress& progress);
    StepReport report_step(float tau);
    void read_state(RelaxedColumns& columns, const std::vector<glm::vec4>& order) const;

    gpu::Device& m_device;
    const PhotonMap& m_photons;
    RelaxSettings m_settings;
    RelaxSurface m_surface;
    KdTree m_tree;       // of the photons where they are
    gpu::Buffer m_start; // where they were, tree order
    gpu::Buffer m_next;  // where a step puts them
    gpu::Buffer m_radii; // of the last step (shaders/photons/search_radius.glsl)
    gpu::Buffer m_moves; // xyz metres, w pressure
    gpu::Buffer m_triangles;
    std::string m_flat_axes;
    std::shared_ptr<const ParameterRows> m_parameters; // with repulsion in layers
    float m_parameter_scale = 0;                       // of its tree
    gpu::Buffer m_reach2;                              // the same, tree order
    gpu::Buffer m_power;                               // rgb, tree order; with flux diffusion
    Constraint m_constraint;
    float m_carry = 0;   // share of the squared radii that the next query looks for
    double m_travel = 0; // farthest a photon can have moved since the tree was built, in radii
    std::vector<std::string> m_notes;
    std::array<double, 3> m_shift{}; // of positions: the map's origin less the scene's
    float m_spacing = 0;
    std::uint32_t m_step = 0;
};

} // namespace photonloupe
