// SPDX-License-Identifier: Apache-2.0
// Profiles of spots and panels, and the plane that directional light is launched from.
#include "trace/emission_frame.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "scene/triangle_math.h"

namespace photonloupe {
namespace {

using glm::dvec3;

// Of normals that count as one.
constexpr double FLAT_COSINE = 1 - 1e-9;
// Share of the scene's depth that directional light starts before it.
constexpr double LAUNCH_MARGIN = 1e-3;

// Unit vectors with which `axis` is a right-handed basis u, axis, v, as x, y, z are.
void build_basis(const dvec3& axis, dvec3& u, dvec3& v) {
    const dvec3 other = std::abs(axis.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 0, 1);
    v = glm::normalize(glm::cross(other, axis));
    u = glm::cross(axis, v);
}

// Spot: cubic in the ramp (KHR_lights_punctual: the square of a linear ramp in the cosine).
double measure_spot(double inner, double outer) {
    return inner + (outer - inner) / 3;
}

void frame_area(const Scene& scene, const shared::Light& light, EmissionFrame& frame) {
    const auto first = std::bit_cast<std::uint32_t>(light.cone.y), count = std::bit_cast<std::uint32_t>(light.cone.z);
    frame.sides = light.cone.w;
    bool has_axis = false;
    for (std::uint32_t i = first; i < first + count; ++i) {
        const shared::EmittingTriangle& triangle = scene.emitting[i];
        const std::optional<dvec3> normal =
            normalize_robustly(compute_area_vector(triangle.v0_cumulative, triangle.v1, triangle.v2));
        if (!normal) // it has no area, and is never drawn
            continue;
        if (!has_axis)
            frame.axis = *normal;
        has_axis = true;
        frame.is_flat &= glm::dot(frame.axis, *normal) >= FLAT_COSINE;
        for (const glm::vec4& corner : {triangle.v0_cumulative, triangle.v1, triangle.v2})
            frame.reach = std::max(frame.reach, glm::distance(dvec3(corner), frame.origin));
    }
    build_basis(frame.axis, frame.u, frame.v);
}

void frame_directional(const Scene& scene, EmissionFrame& frame, bool only_specular) {
    constexpr double INFINITE = std::numeric_limits<double>::infinity();
    dvec3 lo(INFINITE), hi(-INFINITE); // along u, v and the direction
    dvec3 u, v;
    build_basis(frame.axis, u, v);
    const auto include = [&](const dvec3& corner) {
        const dvec3 place{glm::dot(corner, u), glm::dot(corner, v), glm::dot(corner, frame.axis)};
        lo = glm::min(lo, place);
        hi = glm::max(hi, place);
    };
    visit_triangles(scene, only_specular, [&](const dvec3& a, const dvec3& b, const dvec3& c) {
        for (const dvec3& corner : {a, b, c})
            include(corner);
    });
    if (!(lo.x <= hi.x))
        lo = hi = dvec3(0.0); // nothing is there to be lit
    double start = lo.z;      // nothing must stand before it; what lies aside does not count
    visit_triangles(scene, false, [&](const dvec3& a, const dvec3& b, const dvec3& c) {
        const auto place = [&](const dvec3& corner) {
            return dvec3(glm::dot(corner, u), glm::dot(corner, v), glm::dot(corner, frame.axis));
        };
        const dvec3 low = glm::min(place(a), glm::min(place(b), place(c)));
        const dvec3 high = glm::max(place(a), glm::max(place(b), place(c)));
        if (low.x <= hi.x && high.x >= lo.x && low.y <= hi.y && high.y >= lo.y)
            start = std::min(start, low.z);
    });
    start -= LAUNCH_MARGIN * std::max(hi.z - start, glm::length(hi - lo));
    frame.origin = u * lo.x + v * lo.y + frame.axis * start;
    frame.u = u * (hi.x - lo.x);
    frame.v = v * (hi.y - lo.y);
}

// A ball around what is to be lit, and discs beyond everything.
void frame_environment(const Scene& scene, EmissionFrame& frame, bool only_specular) {
    constexpr double INFINITE = std::numeric_limits<double>::infinity();
    dvec3 lo(INFINITE), hi(-INFINITE);
    visit_triangles(scene, only_specular, [&](const dvec3& a, const dvec3& b, const dvec3& c) {
        lo = glm::min(lo, glm::min(a, glm::min(b, c)));
        hi = glm::max(hi, glm::max(a, glm::max(b, c)));
    });
    if (!(lo.x <= hi.x))
        return;
    frame.origin = 0.5 * (lo + hi);
    const auto include = [&](bool only, double& reach) {
        visit_triangles(scene, only, [&](const dvec3& a, const dvec3& b, const dvec3& c) {
            for (const dvec3& corner : {a, b, c})
                reach = std::max(reach, glm::distance(corner, frame.origin));
        });
        reach *= 1 + LAUNCH_MARGIN;
    };
    include(only_specular, frame.disc);
    include(false, frame.launch);
}

} // namespace

bool is_specular(const shared::Material& material) {
    if (scatters(material) && material.absorption_ior.w == 1 && material.base_color_metallic.w == 0 &&
        material.emission_transmission.w == 1)
        return false; // the border of a fog
    return material.base_color_metallic.w > 0 || material.emission_transmission.w > 0 || has_gloss(material) ||
           material.coat.x > 0;
}

double EmissionFrame::find_share(double angle) const {
    if (kind == shared::LIGHT_POINT)
        return 0.5 * (1 - std::cos(angle));
    const double half = std::sin(0.5 * angle), beyond = 2 * half * half; // 1 - cos
    if (kind == shared::LIGHT_SPOT) {
        const double whole = measure_spot(inner, outer), ramp = outer - inner;
        if (beyond <= inner)
            return beyond / whole;
        if (beyond >= outer)
            return beyond > outer ? 2.0 : 1.0;
        const double left = (outer - beyond) / ramp;
        return (inner + ramp / 3 * (1 - left * left * left)) / whole;
    }
    if (kind == shared::LIGHT_AREA) {
        const double sine = std::sin(angle), sine2 = sine * sine;
        const bool is_front = angle <= 0.5 * std::numbers::pi;
        return sides == 1 ? (is_front ? sine2 : 2.0) : is_front ? 0.5 * sine2 : 1 - 0.5 * sine2;
    }
    return 0.5 * beyond;
}

double EmissionFrame::widest() const {
    if (kind == shared::LIGHT_SPOT)
        return 2 * std::asin(std::sqrt(std::min(1.0, 0.5 * outer)));
    return kind == shared::LIGHT_AREA && sides == 1 ? 0.5 * std::numbers::pi : std::numbers::pi;
}

double EmissionFrame::find_measure(const shared::Light& light) const {
    switch (kind) {
    case shared::LIGHT_SPOT:
        return 2 * std::numbers::pi * measure_spot(inner, outer);
    case shared::LIGHT_DIRECTIONAL:
        return glm::length(u) * glm::length(v);
    case shared::LIGHT_ENVIRONMENT:
        return 4 * std::pow(std::numbers::pi * disc, 2);
    case shared::LIGHT_AREA:
        return std::numbers::pi * light.cone.x * sides;
    default:
        return 4 * std::numbers::pi;
    }
}

EmissionFrame frame_emission(const Scene& scene, const shared::Light& light, bool is_specular) {
    EmissionFrame frame;
    frame.kind = find_kind(light);
    frame.origin = dvec3(light.position_kind);
    if (frame.kind == shared::LIGHT_AREA) {
        frame_area(scene, light, frame);
    } else if (frame.kind == shared::LIGHT_ENVIRONMENT) {
        frame_environment(scene, frame, is_specular);
    } else if (frame.kind != shared::LIGHT_POINT) {
        frame.axis = dvec3(light.direction);
        frame.inner = light.cone.x;
        frame.outer = light.cone.y;
        if (frame.kind == shared::LIGHT_DIRECTIONAL)
            frame_directional(scene, frame, is_specular);
        else
            build_basis(frame.axis, frame.u, frame.v);
    }
    return frame;
}

} // namespace photonloupe
