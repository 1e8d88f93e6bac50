// SPDX-License-Identifier: Apache-2.0
// Combines running values of photon loops: sums, least, greatest, moments. 32-bit arithmetic in a fixed order.
#include "script/interpret/reductions.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "script/reference_math.h"

namespace photonloupe::script {
namespace {

constexpr float INF = std::numeric_limits<float>::infinity();

template <class T>
bool beats(Role role, T challenger, T holder) {
    return role == Role::least ? challenger < holder : challenger > holder;
}

// Adds u outer v to xx xy xz yy yz zz.
void add_products(float (&products)[6], const float (&u)[3], const float (&v)[3]) {
    for (int row = 0, i = 0; row < 3; ++row)
        for (int column = row; column < 3; ++column, ++i)
            products[i] += u[row] * v[column];
}

} // namespace

Number find_identity(Role role, Type type) {
    const bool is_real = type == Type::real;
    switch (role) {
    case Role::minimum:
    case Role::least:
        return is_real ? make_real(INF) : make_integer(std::numeric_limits<std::int32_t>::max());
    case Role::maximum:
    case Role::greatest:
        return is_real ? make_real(-INF) : make_integer(std::numeric_limits<std::int32_t>::min());
    default:
        return is_real ? make_real(0.0f) : make_integer(0);
    }
}

Number combine(Role role, Type type, Number a, Number b) {
    const bool is_real = type == Type::real;
    switch (role) {
    case Role::minimum:
        return is_real ? make_real(compute_minimum(a.real, b.real)) : make_integer(std::min(a.integer, b.integer));
    case Role::maximum:
        return is_real ? make_real(compute_maximum(a.real, b.real)) : make_integer(std::max(a.integer, b.integer));
    default:
        assert(role == Role::sum);
        return is_real ? make_real(a.real + b.real) : make_integer(add_wrapping(a.integer, b.integer));
    }
}

bool wins(Role role, Type type, const Choice& challenger, const Choice& holder) {
    const auto decide = [&](auto value, auto held) {
        return beats(role, value, held) || (value == held && challenger.photon < holder.photon);
    };
    return type == Type::real ? decide(challenger.value.real, holder.value.real)
                              : decide(challenger.value.integer, holder.value.integer);
}

void push_point(Moments& moments, std::span<const float> point, std::uint32_t photon) {
    float before[3] = {}, after[3] = {};
    const bool is_first = moments.count == 0;
    if (is_first)
        moments.first_photon = photon;
    moments.count = add_wrapping(moments.count, 1);
    for (std::size_t i = 0; i < point.size(); ++i) {
        if (is_first)
            moments.first_point[i] = point[i];
        before[i] = point[i] - moments.mean[i];
        moments.mean[i] += before[i] / float(moments.count);
        after[i] = point[i] - moments.mean[i];
    }
    add_products(moments.products, before, after);
}

Moments merge_moments(const Moments& a, const Moments& b) {
    if (b.count == 0)
        return a;
    if (a.count == 0)
        return b;
    Moments merged = a;
    merged.count = add_wrapping(a.count, b.count);
    const float share = float(b.count) / float(merged.count);
    float apart[3], scaled[3];
    for (int i = 0; i < 3; ++i) {
        apart[i] = b.mean[i] - a.mean[i];
        scaled[i] = apart[i] * (float(a.count) * share);
        merged.mean[i] = a.mean[i] + apart[i] * share;
    }
    for (int i = 0; i < 6; ++i)
        merged.products[i] = a.products[i] + b.products[i];
    add_products(merged.products, apart, scaled);
    if (b.first_photon < a.first_photon) {
        merged.first_photon = b.first_photon;
        for (int i = 0; i < 3; ++i)
            merged.first_point[i] = b.first_point[i];
    }
    return merged;
}

} // namespace photonloupe::script
