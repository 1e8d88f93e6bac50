// SPDX-License-Identifier: Apache-2.0
// Photon relaxation, a step at a time (METHODS §3): photons repel their neighbours until they lie evenly, each as far
// as its constraint allows, and stay on the surface they lie on.
#pragma once

#include <optional>

#include "photons/layered_tree.h"
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
    bool has_constraint = false;         // the state has its columns
    std::uint64_t off_surface_count = 0; // photons that moved in their tangent plane
};

// The trees that know parameters; without `layered` layers are sought in the tree over positions.
struct LayerTrees {
    const ParameterTree* parameters = nullptr;
    std::shared_ptr<const LayeredTree> layered; // kept as long as the relaxation
};

class Relaxation {
public:
    // Measures the constraint. Without a surface's scene photons move in their tangent planes.
    // `trees` are needed where constraint or repulsion look at parameters.
    Relaxation(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const LayerTrees& trees,
               const RelaxSettings& settings, RelaxSurface surface, const Progress& progress);

    // One step (Jacobi: all photons see the places before it).
    StepReport step(const Progress& progress);

    std::uint32_t step_count() const { return m_step; }
    const RelaxSettings& settings() const { return m_settings; }
    RelaxedColumns read() const;

private:
    void find_surface(const Progress& progress);
    void shift_photons();
    void order_power();
    void repel(float tau, const Progress& progress);
    void move(const Progress& progress);
    void reorder(const Progress& progress);
    StepReport report_step(float tau);
    void read_state(RelaxedColumns& columns, const std::vector<glm::vec4>& order) const;

    gpu::Device& m_device;
    const PhotonMap& m_photons;
    RelaxSettings m_settings;
    RelaxSurface m_surface;
    KdTree m_tree;       // of the photons where they are
    gpu::Buffer m_start; // where they were, tree order
    gpu::Buffer m_next;  // where a step puts them
    gpu::Buffer m_radii; // squared, of the last query
    gpu::Buffer m_moves; // xyz metres, w pressure
    gpu::Buffer m_triangles;
    std::shared_ptr<const LayeredTree> m_layered;
    Layers m_layers; // of repulsion
    std::uint32_t m_parameter_rows = 0;
    GatherShape m_shape; // of repulsion
    gpu::Buffer m_power; // rgb, tree order; with flux diffusion
    Constraint m_constraint;
    float m_carry = 0;               // share of the squared radii that the next query looks for
    std::array<double, 3> m_shift{}; // of positions: the map's origin less the scene's
    float m_spacing = 0;
    std::uint32_t m_step = 0;
};

} // namespace photonloupe
