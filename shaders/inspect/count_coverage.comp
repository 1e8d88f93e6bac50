// SPDX-License-Identifier: Apache-2.0
// How many curves cover each pixel: a falling curve covers the rows from where it enters its column at the left to
// where it leaves it, so the pixel's count is the difference of two running sums of crossings; rising ones likewise.
// Inputs: column_jobs (left and right line of a column in up to two gaps), crossings.
// Outputs: coverage (context, selection; by row), largest (of either).
#include "shared/prelude.glsl"
#include "shared/parallel.h"
#pragma binding readonly uvec4 column_jobs
#pragma binding readonly uvec2 crossings
#pragma binding uvec2 coverage
#pragma binding uint largest

layout(push_constant) uniform Push { CoverageSettings settings; };

uvec2 sum_crossings(uint row, uint job) {
    uvec2 sum = uvec2(0u);
    if (job == NO_JOB) return sum;
    for (uint part = 0u; part < settings.part_count; ++part)
        sum += crossings[(part * (settings.row_count + 2u) + row) * settings.job_count + job];
    return sum;
}

void main() {
    uint column = gl_GlobalInvocationID.x;
    if (column >= settings.width) return;
    uvec4 lines = column_jobs[column];
    uvec2 entered = uvec2(0u); // falling at the left, rising at the right: up to this row
    uvec2 gone = uvec2(0u);    // the others: up to the row before
    uint most = 0u;
    for (uint row = 0u; row <= settings.row_count; ++row) {
        uvec2 at_left = sum_crossings(row, lines.x) + sum_crossings(row, lines.z);
        uvec2 at_right = sum_crossings(row, lines.y) + sum_crossings(row, lines.w);
        entered += uvec2(at_left.x, at_right.y);
        if (row > 0u) {
            uint count = entered.x + entered.y - gone.x - gone.y;
            coverage[(settings.first_row + row - 1u) * settings.width + column][settings.set] = count;
            most = max(most, count);
        }
        gone += uvec2(at_right.x, at_left.y);
    }
    atomicMax(largest[settings.set], most);
}
