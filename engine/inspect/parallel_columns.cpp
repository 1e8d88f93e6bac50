// SPDX-License-Identifier: Apache-2.0
// Columns of pixels and polynomials for the kernels that draw curves.
#include "inspect/parallel_columns.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/split_work.h"

namespace photonloupe::inspect {
namespace {

constexpr std::uint32_t RISES = 1;
// Curves below which another thread costs more than it saves.
constexpr std::size_t LEAST_PART = 4096;

std::int32_t clip(float x, std::uint32_t width) {
    return static_cast<std::int32_t>(std::clamp(x, 0.0f, static_cast<float>(width)));
}

// Collects jobs and notes them under the columns that they bound.
class JobList {
public:
    explicit JobList(std::uint32_t width) { m_list.column_jobs.assign(width, glm::uvec4(shared::NO_JOB)); }

    // Lines at the borders of the regular columns: one column's right is the next one's left.
    void add_regular(std::uint32_t gap, const GapColumns& columns) {
        if (columns.first_regular >= columns.end_regular)
            return;
        for (std::int32_t x = columns.first_regular; x <= columns.end_regular; ++x) {
            const std::uint32_t job = add(gap, x - columns.first, x - columns.first);
            if (x > columns.first_regular)
                note(x - 1, job - 1, job);
        }
        pad();
    }

    // Two lines a column: a curve may be in it and not in the next.
    void add_ragged(std::uint32_t gap, const GapColumns& columns) {
        for (std::int32_t x = columns.first; x < columns.end; ++x) {
            if (x >= columns.first_regular && x < columns.end_regular)
                continue;
            const std::int32_t first = x - columns.first;
            const std::uint32_t left = add(gap, first, first);
            note(x, left, add(gap, first + 1, first));
        }
        pad();
    }

    std::uint32_t count_groups() const {
        return static_cast<std::uint32_t>(m_list.jobs.size()) / shared::JOBS_PER_GROUP;
    }
    CrossingJobs& list() { return m_list; }

private:
    std::uint32_t add(std::uint32_t gap, std::int32_t u, std::int32_t first) {
        m_list.jobs.push_back({static_cast<float>(u), static_cast<float>(first), gap, 0});
        return static_cast<std::uint32_t>(m_list.jobs.size() - 1);
    }
    void note(std::int32_t column, std::uint32_t left, std::uint32_t right) {
        glm::uvec4& jobs = m_list.column_jobs[static_cast<std::size_t>(column)];
        const std::size_t at = jobs[0] == shared::NO_JOB ? 0 : 2;
        jobs[at] = left;
        jobs[at + 1] = right;
    }
    // A group's jobs share their gap.
    void pad() {
        while (m_list.jobs.size() % shared::JOBS_PER_GROUP != 0)
            m_list.jobs.push_back(m_list.jobs.back());
    }

    CrossingJobs m_list;
};

struct Gap {
    glm::dvec2 from, to, tangents;
    double base;
};

// Doubles: around the gap's first column the coefficients cancel where a curve begins far from it.
glm::vec4 fit_cubic(const Gap& gap) {
    const double width = gap.to.x - gap.from.x;
    const double slope = (gap.to.y - gap.from.y) / width;
    const double a = (gap.tangents.x + gap.tangents.y - 2 * slope) / (width * width);
    const double b = (3 * slope - 2 * gap.tangents.x - gap.tangents.y) / width;
    const double shift = gap.base - gap.from.x; // t = u + shift
    const double c = gap.tangents.x;
    const float cubic = static_cast<float>(a);
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(cubic) & ~RISES;
    const bool rises = gap.to.y < gap.from.y;
    return {std::bit_cast<float>(bits | (rises ? RISES : 0)), 3 * a * shift + b, (3 * a * shift + 2 * b) * shift + c,
            ((a * shift + b) * shift + c) * shift + gap.from.y + 1};
}

} // namespace

std::vector<GapColumns> find_gap_columns(const AxisLayout& layout) {
    std::vector<GapColumns> gaps;
    for (std::size_t i = 0; i + 1 < layout.places.size(); ++i) {
        const AxisPlace &left = layout.places[i], &right = layout.places[i + 1];
        const auto clipped = [&](float x) { return clip(x, layout.width); };
        gaps.push_back({clipped(std::floor(left.center.x - left.rx)), clipped(std::ceil(left.center.x + left.rx)),
                        clipped(std::floor(right.center.x - right.rx)), clipped(std::ceil(right.center.x + right.rx))});
    }
    return gaps;
}

CrossingJobs list_crossing_jobs(const AxisLayout& layout) {
    const std::vector<GapColumns> gaps = find_gap_columns(layout);
    JobList list(layout.width);
    for (std::uint32_t gap = 0; gap < gaps.size(); ++gap)
        list.add_regular(gap, gaps[gap]);
    list.list().regular_group_count = list.count_groups();
    for (std::uint32_t gap = 0; gap < gaps.size(); ++gap)
        list.add_ragged(gap, gaps[gap]);
    list.list().ragged_group_count = list.count_groups() - list.list().regular_group_count;
    return std::move(list.list());
}

std::vector<glm::uvec4> list_column_gaps(const AxisLayout& layout) {
    std::vector<glm::uvec4> columns(layout.width, glm::uvec4(shared::NO_JOB));
    const std::vector<GapColumns> gaps = find_gap_columns(layout);
    for (std::uint32_t gap = 0; gap < gaps.size(); ++gap)
        for (std::int32_t x = gaps[gap].first; x < gaps[gap].end; ++x) {
            glm::uvec4& entry = columns[static_cast<std::size_t>(x)];
            const std::size_t at = entry[1] == shared::NO_JOB ? 0 : 2;
            entry[at] = static_cast<std::uint32_t>(gaps[gap].first);
            entry[at + 1] = gap;
        }
    return columns;
}

Polynomials fit_polynomials(const Curves& curves, const AxisLayout& layout) {
    const std::vector<GapColumns> columns = find_gap_columns(layout);
    const std::size_t count = curves.count(), gap_count = curves.gap_count();
    Polynomials fitted;
    fitted.coefficients.resize(count * gap_count);
    fitted.extents.resize(count * gap_count);
    split_work(count, LEAST_PART, [&](std::size_t first, std::size_t end) {
        for (std::size_t g = 0; g < gap_count; ++g)
            for (std::size_t i = first; i < end; ++i) {
                const glm::vec2 tangents = curves.tangents[i * gap_count + g];
                if (std::isnan(tangents.x))
                    continue;
                const glm::dvec2 from = curves.points[i * curves.axis_count + g];
                const glm::dvec2 to = curves.points[i * curves.axis_count + g + 1];
                const double base = columns[g].first;
                fitted.coefficients[g * count + i] = fit_cubic({from, to, tangents, base});
                fitted.extents[g * count + i] = {from.x - base, to.x - base, 0, 0};
            }
    });
    return fitted;
}

} // namespace photonloupe::inspect
