// SPDX-License-Identifier: Apache-2.0
// Offsets and sizes of a C++ struct's members, found by taking it apart: a struct that grows needs no change here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace photonloupe::test {

struct HostMember {
    std::uint32_t offset;
    std::uint32_t size_bytes;
};

struct HostStruct {
    std::uint32_t size_bytes;
    std::vector<HostMember> members;
};

// Stands for a value of any member's type.
struct AnyValue {
    template <class T>
    operator T() const;
};

// The most values T can be initialized from.
template <class T, class... Values>
consteval std::size_t count_members() {
    if constexpr (requires { T{Values{}..., AnyValue{}}; })
        return count_members<T, Values..., AnyValue>();
    else
        return sizeof...(Values);
}

template <class T, class... Members>
HostStruct measure(const T& whole, const Members&... members) {
    const auto* begin = reinterpret_cast<const std::byte*>(&whole);
    return {sizeof(T),
            {{static_cast<std::uint32_t>(reinterpret_cast<const std::byte*>(&members) - begin), sizeof(Members)}...}};
}

template <class T>
HostStruct measure_host_struct() {
    constexpr std::size_t COUNT = count_members<T>();
    static_assert(COUNT >= 1 && COUNT <= 16, "add a case below");
    const T whole{};
#define PHOTONLOUPE_CASE(count, ...)                                                                                   \
    if constexpr (COUNT == count) {                                                                                    \
        const auto& [__VA_ARGS__] = whole;                                                                             \
        return measure(whole, __VA_ARGS__);                                                                            \
    }
    PHOTONLOUPE_CASE(1, a)
    PHOTONLOUPE_CASE(2, a, b)
    PHOTONLOUPE_CASE(3, a, b, c)
    PHOTONLOUPE_CASE(4, a, b, c, d)
    PHOTONLOUPE_CASE(5, a, b, c, d, e)
    PHOTONLOUPE_CASE(6, a, b, c, d, e, f)
    PHOTONLOUPE_CASE(7, a, b, c, d, e, f, g)
    PHOTONLOUPE_CASE(8, a, b, c, d, e, f, g, h)
    PHOTONLOUPE_CASE(9, a, b, c, d, e, f, g, h, i)
    PHOTONLOUPE_CASE(10, a, b, c, d, e, f, g, h, i, j)
    PHOTONLOUPE_CASE(11, a, b, c, d, e, f, g, h, i, j, k)
    PHOTONLOUPE_CASE(12, a, b, c, d, e, f, g, h, i, j, k, l)
    PHOTONLOUPE_CASE(13, a, b, c, d, e, f, g, h, i, j, k, l, m)
    PHOTONLOUPE_CASE(14, a, b, c, d, e, f, g, h, i, j, k, l, m, n)
    PHOTONLOUPE_CASE(15, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o)
    PHOTONLOUPE_CASE(16, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p)
#undef PHOTONLOUPE_CASE
}

} // namespace photonloupe::test
