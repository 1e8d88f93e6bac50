// SPDX-License-Identifier: Apache-2.0
// Symmetric 2 × 2 matrices (a b; b c): eigenvalues, largest first, and the first one's unit eigenvector.

struct Eigen {
    float first;
    float second;  // never negative
    vec2 axis;     // of the first
};

Eigen decompose(float a, float b, float c) {
    float mean = 0.5 * (a + c);
    float difference = 0.5 * (a - c);
    float root = sqrt(difference * difference + b * b);
    vec2 axis = difference >= 0.0 ? vec2(difference + root, b) : vec2(b, root - difference);
    float size = max(abs(axis.x), abs(axis.y));
    axis = size > 0.0 ? normalize(axis / size) : vec2(1.0, 0.0);
    return Eigen(mean + root, max(mean - root, 0.0), axis);
}
