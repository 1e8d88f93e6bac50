// SPDX-License-Identifier: Apache-2.0
// Principal component analysis: moments of pushed points and their decomposition, step by step as
// engine/script/interpret/reductions.cpp and decompose_moments.cpp.

struct Moments {
    int count;
    uint first_photon; // gave first_point
    vec3 first_point;
    vec3 mean;
    vec3 diagonal;     // xx yy zz: sums of products of deviations
    vec3 mixed;        // xy xz yz
};

struct Decomposition {
    int dimensions; // 0: none
    vec3 values;
    vec3 first, second, third; // unit vectors
    vec3 mean;
};

const Moments NO_MOMENTS = Moments(0, 0xffffffffu, vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));

void push_point(inout Moments moments, vec3 point) {
    moments.first_photon = moments.count == 0 ? uint(photon) : moments.first_photon;
    moments.first_point = moments.count == 0 ? point : moments.first_point;
    moments.count += 1;
    precise vec3 before = point - moments.mean;
    precise vec3 mean = moments.mean + before / float(moments.count);
    precise vec3 after = point - mean;
    precise vec3 diagonal = moments.diagonal + before * after;
    precise vec3 mixed = moments.mixed + before.xxy * after.yzz;
    moments.mean = mean;
    moments.diagonal = diagonal;
    moments.mixed = mixed;
}

vec3 normalize_axis(vec3 v) {
    precise float size = sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return v / size;
}

// The sign is free: towards the first pushed point; where that lies across, towards x, then y, then z (METHODS §4).
vec3 point_towards(vec3 axis, vec3 point) {
    precise float side = axis.x * point.x + axis.y * point.y + axis.z * point.z;
    side = side == 0.0 ? axis.x : side;
    side = side == 0.0 ? axis.y : side;
    side = side == 0.0 ? axis.z : side;
    return side < 0.0 ? -axis : axis;
}

// Matrix (a b; b c) of trace 1.
void decompose_plane(float a, float b, float c, inout Decomposition result) {
    precise float middle = 0.5 * (a + c), difference = 0.5 * (a - c);
    precise float root = sqrt(difference * difference + b * b);
    precise float along = difference >= 0.0 ? difference + root : root - difference;
    result.values = vec3(middle + root, max(middle - root, 0.0), 0.0);
    vec3 axis = difference >= 0.0 ? vec3(along, b, 0.0) : vec3(b, along, 0.0);
    result.first = root > 0.0 ? normalize_axis(axis) : vec3(1.0, 0.0, 0.0);
    result.second = vec3(-result.first.y, result.first.x, 0.0);
    result.third = vec3(0.0);
}

// Turns the axes p and q so that the matrix's entry between them vanishes; to_p, to_q: entries with the third axis.
void rotate_axes(inout float pp, inout float qq, inout float pq, inout float to_p, inout float to_q, inout vec3 p,
                 inout vec3 q) {
    if (pq == 0.0) return;
    precise float theta = (qq - pp) / (2.0 * pq);
    precise float t = (theta >= 0.0 ? 1.0 : -1.0) / (abs(theta) + sqrt(theta * theta + 1.0));
    precise float c = 1.0 / sqrt(t * t + 1.0);
    precise float s = t * c;
    precise float new_pp = pp - t * pq, new_qq = qq + t * pq;
    precise float new_to_p = c * to_p - s * to_q, new_to_q = s * to_p + c * to_q;
    precise vec3 new_p = c * p - s * q, new_q = s * p + c * q;
    pp = new_pp;
    qq = new_qq;
    pq = 0.0;
    to_p = new_to_p;
    to_q = new_to_q;
    p = new_p;
    q = new_q;
}

void order_axes(inout float a, inout float b, inout vec3 p, inout vec3 q) {
    if (a >= b) return;
    float value = a;
    a = b;
    b = value;
    vec3 axis = p;
    p = q;
    q = axis;
}

const uint JACOBI_SWEEPS = 6u;

void decompose_space(vec3 diagonal, vec3 mixed, inout Decomposition result) {
    vec3 x = vec3(1.0, 0.0, 0.0), y = vec3(0.0, 1.0, 0.0), z = vec3(0.0, 0.0, 1.0);
    for (uint sweep = 0u; sweep < JACOBI_SWEEPS; ++sweep) {
        rotate_axes(diagonal.x, diagonal.y, mixed.x, mixed.y, mixed.z, x, y);
        rotate_axes(diagonal.x, diagonal.z, mixed.y, mixed.x, mixed.z, x, z);
        rotate_axes(diagonal.y, diagonal.z, mixed.z, mixed.x, mixed.y, y, z);
    }
    turns += JACOBI_SWEEPS;
    diagonal = max(diagonal, vec3(0.0));
    order_axes(diagonal.x, diagonal.y, x, y);
    order_axes(diagonal.x, diagonal.z, x, z);
    order_axes(diagonal.y, diagonal.z, y, z);
    result.values = diagonal;
    result.first = normalize_axis(x);
    result.second = normalize_axis(y);
    result.third = normalize_axis(z);
}

int decompose_moments(Moments moments, int dimensions, out Decomposition result) {
    result = Decomposition(0, vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    precise float trace = moments.diagonal.x + moments.diagonal.y;
    if (dimensions == 3) trace = trace + moments.diagonal.z;
    if (moments.count < 2 || !(trace > 0.0) || trace == INFINITY) return 0;
    precise vec3 diagonal = moments.diagonal / trace, mixed = moments.mixed / trace;
    if (dimensions == 2) decompose_plane(diagonal.x, mixed.x, diagonal.y, result);
    else decompose_space(diagonal, mixed, result);
    precise float scale = trace / float(moments.count);
    result.dimensions = dimensions;
    result.values *= scale;
    result.first = point_towards(result.first, moments.first_point);
    result.second = point_towards(result.second, moments.first_point);
    if (dimensions == 3) result.third = point_towards(result.third, moments.first_point);
    result.mean = moments.mean;
    return 1;
}

// `component` and `axis` are -1 for none.
float read_eigenvalue(Decomposition d, int component) {
    float found = component == 0 ? d.values.x : component == 1 ? d.values.y : d.values.z;
    return component < 0 ? NAN : found;
}
float read_eigenvector(Decomposition d, int component, int axis) {
    vec3 v = component == 0 ? d.first : component == 1 ? d.second : d.third;
    return component < 0 || axis < 0 ? NAN : axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
float read_mean(Decomposition d, int axis) {
    return axis < 0 ? NAN : axis == 0 ? d.mean.x : axis == 1 ? d.mean.y : d.mean.z;
}
