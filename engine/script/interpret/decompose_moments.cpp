// SPDX-License-Identifier: Apache-2.0
// Eigen decomposition of pushed points' covariance: 2 × 2 in closed form, 3 × 3 by Jacobi rotations.
#include "script/interpret/reductions.h"

#include <cmath>
#include <utility>

namespace photonloupe::script {
namespace {

// Rotations halve the digits left to go, quadratically: float's 24 bits are reached in five sweeps.
constexpr int JACOBI_SWEEPS = 6;

struct Matrix {
    float at[3][3] = {};
};

void normalize(float (&v)[3]) {
    const float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (float& x : v)
        x /= length;
}

// Matrix (a b; b c) of trace 1.
void decompose_plane(float a, float b, float c, Decomposition& result) {
    const float middle = 0.5f * (a + c), difference = 0.5f * (a - c);
    const float root = std::sqrt(difference * difference + b * b);
    result.eigenvalues[0] = middle + root;
    result.eigenvalues[1] = std::fmax(middle - root, 0.0f);
    float (&axis)[3] = result.eigenvectors[0];
    axis[0] = difference >= 0 ? difference + root : b;
    axis[1] = difference >= 0 ? b : root - difference;
    if (root > 0)
        normalize(axis);
    else
        axis[0] = 1;
    result.eigenvectors[1][0] = -axis[1];
    result.eigenvectors[1][1] = axis[0];
}

// Turns axes p and q so that the symmetric matrix's entry (p, q) vanishes; r is the third axis.
void rotate(Matrix& m, Matrix& axes, int p, int q, int r) {
    const float entry = m.at[p][q];
    if (entry == 0)
        return;
    const float theta = (m.at[q][q] - m.at[p][p]) / (2 * entry);
    const float t = (theta >= 0 ? 1.0f : -1.0f) / (std::abs(theta) + std::sqrt(theta * theta + 1));
    const float c = 1 / std::sqrt(t * t + 1), s = t * c;
    m.at[p][p] -= t * entry;
    m.at[q][q] += t * entry;
    m.at[p][q] = m.at[q][p] = 0;
    const float to_p = m.at[p][r], to_q = m.at[q][r];
    m.at[p][r] = m.at[r][p] = c * to_p - s * to_q;
    m.at[q][r] = m.at[r][q] = s * to_p + c * to_q;
    for (int i = 0; i < 3; ++i) {
        const float along_p = axes.at[p][i], along_q = axes.at[q][i];
        axes.at[p][i] = c * along_p - s * along_q;
        axes.at[q][i] = s * along_p + c * along_q;
    }
}

void order(Decomposition& result, int i, int j) {
    if (result.eigenvalues[i] >= result.eigenvalues[j])
        return;
    std::swap(result.eigenvalues[i], result.eigenvalues[j]);
    std::swap(result.eigenvectors[i], result.eigenvectors[j]);
}

void decompose_space(Matrix m, Decomposition& result) {
    Matrix axes;
    for (int i = 0; i < 3; ++i)
        axes.at[i][i] = 1;
    for (int sweep = 0; sweep < JACOBI_SWEEPS; ++sweep) {
        rotate(m, axes, 0, 1, 2);
        rotate(m, axes, 0, 2, 1);
        rotate(m, axes, 1, 2, 0);
    }
    for (int i = 0; i < 3; ++i) {
        result.eigenvalues[i] = std::fmax(m.at[i][i], 0.0f);
        for (int j = 0; j < 3; ++j)
            result.eigenvectors[i][j] = axes.at[i][j];
        normalize(result.eigenvectors[i]);
    }
    order(result, 0, 1);
    order(result, 0, 2);
    order(result, 1, 2);
}

// The sign is free: towards the first pushed point; where that lies across, towards x, then y, then z (METHODS §4).
void point_towards(float (&vector)[3], const float (&first)[3]) {
    float side = vector[0] * first[0] + vector[1] * first[1] + vector[2] * first[2];
    for (int i = 0; i < 3 && side == 0; ++i)
        side = vector[i];
    if (side < 0)
        for (float& x : vector)
            x = -x;
}

} // namespace

bool decompose_moments(const Moments& moments, std::int32_t dimensions, Decomposition& decomposition) {
    decomposition = {};
    if (moments.count < 2)
        return false;
    const float (&p)[6] = moments.products;
    const float trace = dimensions == 2 ? p[0] + p[3] : p[0] + p[3] + p[5];
    if (!(trace > 0) || !std::isfinite(trace))
        return false;
    if (dimensions == 2)
        decompose_plane(p[0] / trace, p[1] / trace, p[3] / trace, decomposition);
    else
        decompose_space({{{p[0] / trace, p[1] / trace, p[2] / trace},
                          {p[1] / trace, p[3] / trace, p[4] / trace},
                          {p[2] / trace, p[4] / trace, p[5] / trace}}},
                        decomposition);
    const float scale = trace / float(moments.count);
    for (int i = 0; i < 3; ++i) {
        decomposition.eigenvalues[i] *= scale;
        decomposition.mean[i] = moments.mean[i];
        if (i < dimensions)
            point_towards(decomposition.eigenvectors[i], moments.first_point);
    }
    decomposition.dimensions = dimensions;
    return true;
}

} // namespace photonloupe::script
