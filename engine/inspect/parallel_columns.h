// SPDX-License-Identifier: Apache-2.0
// Which columns of pixels the gaps between the axes cover, and the curves as polynomials over them: what the kernels
// of shaders/inspect read.
#pragma once

#include <glm/vec4.hpp>

#include "inspect/parallel_curves.h"
#include "shared/parallel.h"

namespace photonloupe::inspect {

// The columns of a gap, first to end. Under a closed axis curves begin and end anywhere: those columns are ragged; in
// the others every curve passes from the left border to the right one.
struct GapColumns {
    std::int32_t first = 0, first_regular = 0, end_regular = 0, end = 0;
};

std::vector<GapColumns> find_gap_columns(const AxisLayout& layout);

// The lines at which crossings are counted, padded to whole groups: regular groups first.
struct CrossingJobs {
    std::vector<shared::CrossingJob> jobs;
    std::uint32_t regular_group_count = 0, ragged_group_count = 0;
    std::vector<glm::uvec4> column_jobs; // by image column: left and right line in up to two gaps, or NO_JOB
};

CrossingJobs list_crossing_jobs(const AxisLayout& layout);

// By image column: first column and number of up to two gaps; NO_JOB: none.
std::vector<glm::uvec4> list_column_gaps(const AxisLayout& layout);

// By gap and curve. y = ((x u + y) u + z) u + w with u in pixels from the gap's first column and the image's top at
// y = 1; the last bit of x is set where the curve rises on the screen. Extents: first and last u, both 0 where there
// is no curve: it then stays at y = 0.
struct Polynomials {
    std::vector<glm::vec4> coefficients, extents;
};

Polynomials fit_polynomials(const Curves& curves, const AxisLayout& layout);

} // namespace photonloupe::inspect
