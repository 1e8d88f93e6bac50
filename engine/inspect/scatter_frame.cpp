// SPDX-License-Identifier: Apache-2.0
// Maps data to pixels and back.
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/error.h"
#include "inspect/scatter.h"

namespace photonloupe::inspect {
namespace {

constexpr double TURN = 2 * std::numbers::pi;

Range choose_range(const Column& column, const std::optional<Range>& given) {
    auto [low, high] = given.value_or(Range{column.low, column.high});
    if (!std::isfinite(low) || !std::isfinite(high) || low > high)
        throw Error("scatter: the range of " + column.name + " must be two finite numbers, the lower one first");
    if (low == high)
        return {low - 0.5, high + 0.5};
    return {low, high};
}

double share_of(const Range& range, double value) {
    return (value - range.first) / (range.second - range.first);
}

double pick_share(const Range& range, double share) {
    return range.first + share * (range.second - range.first);
}

} // namespace

ScatterFrame::ScatterFrame(const Column& x, const Column& y, const ScatterSettings& settings)
    : m_x(choose_range(x, settings.x_range)), m_y(choose_range(y, settings.y_range)), m_is_polar(settings.is_polar) {
    // Splats at the ends of a range are whole.
    const double margin = std::ceil(static_cast<double>(settings.point_radius));
    const glm::dvec2 size(settings.width, settings.height);
    m_extent = glm::max(size - 2 * margin, glm::dvec2(1.0));
    if (m_is_polar) {
        m_extent = glm::dvec2(std::min(m_extent.x, m_extent.y));
        if (!settings.y_range)
            m_y.first = std::min(m_y.first, 0.0); // a radius counts from the middle
        m_turn = x.period > 0 ? static_cast<double>(x.period) : m_x.second - m_x.first;
        m_angle_origin = x.period > 0 ? 0.0 : m_x.first;
    }
    m_corner = 0.5 * (size - m_extent);
}

glm::dvec2 ScatterFrame::to_pixel(double x, double y) const {
    if (!m_is_polar)
        return m_corner + m_extent * glm::dvec2(share_of(m_x, x), 1 - share_of(m_y, y));
    const double angle = TURN * (x - m_angle_origin) / m_turn;
    return m_corner + m_extent * 0.5 * (1.0 + share_of(m_y, y) * glm::dvec2(std::sin(angle), -std::cos(angle)));
}

glm::dvec2 ScatterFrame::to_data(const glm::dvec2& pixel) const {
    const glm::dvec2 share = (pixel - m_corner) / m_extent;
    if (!m_is_polar)
        return {pick_share(m_x, share.x), pick_share(m_y, 1 - share.y)};
    const glm::dvec2 away = 2.0 * share - 1.0;
    const double angle = m_angle_origin + m_turn * std::atan2(away.x, -away.y) / TURN;
    return {angle - m_turn * std::floor((angle - m_x.first) / m_turn), pick_share(m_y, glm::length(away))};
}

} // namespace photonloupe::inspect
