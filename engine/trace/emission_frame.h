// SPDX-License-Identifier: Apache-2.0
// How a light's power lies on the unit square that photons are drawn from: each part of the square holds power in
// proportion to its area, so that all photons of a light carry the same flux (shaders/trace/emit.glsl is the inverse).
#pragma once

#include "scene/scene.h"

namespace photonloupe {

// Point, spot, area: directions about `axis`, along rows by their angle to it, along columns by azimuth from `u` to
// `v`. Directional: starts origin + s·u + t·v, all along `axis`. Environment: directions as of a point light, each with
// starts on a disc across it.
struct EmissionFrame {
    std::uint32_t kind = shared::LIGHT_POINT;
    glm::dvec3 origin{0.0}; // from the scene's; area: the middle
    glm::dvec3 u{1, 0, 0}, v{0, 0, 1}, axis{0, 1, 0};
    double inner = 0, outer = 0; // spot: 1 - cos
    double reach = 0;            // area: of a ball around the middle that holds it, metres
    double sides = 1;            // area: that shine
    bool is_flat = true;         // area: one normal serves all of it
    double disc = 0, launch = 0; // environment: radius of the discs, their distance from the origin

    // Where a direction at this angle to the axis lies along the rows; above 1: it gets no power.
    double find_share(double angle) const;
    // The largest angle to the axis that gets power.
    double widest() const;
    // The light's power over intensity, radiance or irradiance.
    double find_measure(const shared::Light& light) const;
};

// `is_specular`: of what a directional light shines on, only what is specular matters.
EmissionFrame frame_emission(const Scene& scene, const shared::Light& light, bool is_specular);

// Whether a material reflects or transmits specularly.
bool is_specular(const shared::Material& material);

// Corners relative to the scene's origin, of all triangles or of those that are specular.
template <class Use>
void visit_triangles(const Scene& scene, bool only_specular, const Use& use) {
    for (const shared::Triangle& triangle : scene.triangles)
        if (!only_specular || is_specular(scene.materials[find_material(triangle)]))
            use(glm::dvec3(triangle.v0_object), glm::dvec3(triangle.v1_material), glm::dvec3(triangle.v2_source));
}

} // namespace photonloupe
