// SPDX-License-Identifier: Apache-2.0
// Counter-based random numbers: the same on host and device, uniform, independent, and nets where they should be.
#include "shared/random.h"

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

using shared::random_bits;
using shared::sample_sobol;
using shared::sobol_bits;

constexpr std::uint32_t SEED = 20'240'601;

TEST(Random, device_draws_the_same_bits_as_the_host) {
    std::mt19937 engine(3);
    std::vector<glm::uvec4> keys;
    for (std::uint32_t corner : {0u, 1u, 0x7fffffffu, 0x80000000u, 0xffffffffu})
        for (std::uint32_t dimension = 0; dimension < 3; ++dimension)
            keys.emplace_back(corner, corner, corner, dimension);
    for (int i = 0; i < 100'000; ++i) {
        const std::uint32_t seed = engine(), index = engine(), bounce = engine() % 64;
        keys.emplace_back(seed, i % 2 ? index : std::uint32_t(i), bounce, engine() % 8);
    }
    const auto drawn = run_probe<glm::uvec4>(get_device(), "probe_random.comp", keys);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto [seed, index, bounce, dimension] = std::array{keys[i].x, keys[i].y, keys[i].z, keys[i].w};
        const std::uint32_t word = random_bits(seed, index, bounce, dimension);
        const glm::uvec4 expected(word, std::bit_cast<std::uint32_t>(shared::to_unit_float(word)),
                                  sobol_bits(index, dimension % 3), sample_sobol(seed, index, dimension % 3));
        ASSERT_EQ(drawn[i], expected) << "key " << i;
    }
}

TEST(Random, unit_float_stays_below_one) {
    EXPECT_EQ(shared::to_unit_float(0u), 0.0f);
    EXPECT_LT(shared::to_unit_float(0xffffffffu), 1.0f);
    EXPECT_EQ(shared::to_unit_float(0x80000000u), 0.5f);
}

// Pearson's χ² of counts against equal ones, in standard deviations from its mean.
double measure_unevenness(const std::vector<std::uint32_t>& counts) {
    double total = 0, chi2 = 0;
    for (std::uint32_t count : counts)
        total += count;
    const double expected = total / double(counts.size()), freedom = double(counts.size()) - 1;
    for (std::uint32_t count : counts)
        chi2 += (count - expected) * (count - expected) / expected;
    return (chi2 - freedom) / std::sqrt(2 * freedom);
}

// One chance in about two million for each test with this seed; it either always passes or never.
constexpr double UNLIKELY = 5.0;
constexpr std::uint32_t DRAWS = 1u << 20;

struct Axis {
    const char* name;
    std::function<std::uint32_t(std::uint32_t)> draw;
};

// Along each argument of the hash, the others at rest; and each of its four words.
std::vector<Axis> list_axes() {
    std::vector<Axis> axes{{"seed", [](std::uint32_t i) { return random_bits(i, 5, 2, 1); }},
                           {"index", [](std::uint32_t i) { return random_bits(SEED, i, 2, 1); }},
                           {"bounce", [](std::uint32_t i) { return random_bits(SEED, 5, i, 1); }},
                           {"dimension", [](std::uint32_t i) { return random_bits(SEED, 5, 2, i); }}};
    for (int word = 0; word < 4; ++word)
        axes.push_back({"word", [word](std::uint32_t i) { return shared::hash_pcg4d({i, 2, 1, SEED})[word]; }});
    return axes;
}

std::vector<std::uint32_t> count_bytes(const Axis& axis, int shift) {
    std::vector<std::uint32_t> counts(256);
    for (std::uint32_t i = 0; i < DRAWS; ++i)
        ++counts[axis.draw(i) >> shift & 255];
    return counts;
}

TEST(Random, upper_bits_are_uniform_along_every_argument) {
    for (const Axis& axis : list_axes())
        EXPECT_LT(std::abs(measure_unevenness(count_bytes(axis, 24))), UNLIKELY) << axis.name;
}

// Not along the dimension, of which a few values occur; unit floats drop these bits.
TEST(Random, lower_bits_are_uniform_along_the_others) {
    for (const Axis& axis : list_axes())
        if (std::string(axis.name) != "dimension") {
            EXPECT_LT(std::abs(measure_unevenness(count_bytes(axis, 0))), UNLIKELY) << axis.name;
        }
}

TEST(Random, neighbors_along_every_argument_are_independent) {
    for (const Axis& axis : list_axes()) {
        std::vector<std::uint32_t> pairs(64 * 64);
        for (std::uint32_t i = 0; i < DRAWS; ++i)
            ++pairs[(axis.draw(2 * i) >> 26) * 64 + (axis.draw(2 * i + 1) >> 26)];
        EXPECT_LT(std::abs(measure_unevenness(pairs)), UNLIKELY) << axis.name;
    }
}

TEST(Random, words_of_one_draw_are_independent) {
    for (int first = 0; first < 4; ++first)
        for (int second = first + 1; second < 4; ++second) {
            std::vector<std::uint32_t> pairs(64 * 64);
            for (std::uint32_t i = 0; i < DRAWS; ++i) {
                const glm::uvec4 words = shared::hash_pcg4d({i, 2, 1, SEED});
                ++pairs[(words[first] >> 26) * 64 + (words[second] >> 26)];
            }
            EXPECT_LT(std::abs(measure_unevenness(pairs)), UNLIKELY) << first << ' ' << second;
        }
}

// The textbook's construction: direction numbers m, columns m · 2^(32 - i) (Joe and Kuo 2008, dimensions 1 to 3).
std::uint32_t find_sobol_by_definition(std::uint32_t index, std::uint32_t dimension) {
    std::array<std::uint64_t, 33> m{0, 1};
    for (std::uint32_t i = 2; i <= 32; ++i) {
        if (dimension == 0)
            m[i] = 1;
        else if (dimension == 1)
            m[i] = 2 * m[i - 1] ^ m[i - 1];
        else
            m[i] = i == 2 ? 3 : 2 * m[i - 1] ^ 4 * m[i - 2] ^ m[i - 2];
    }
    std::uint32_t result = 0;
    for (std::uint32_t bit = 0; bit < 32; ++bit)
        if (index >> bit & 1)
            result ^= static_cast<std::uint32_t>(m[bit + 1] << (31 - bit));
    return result;
}

TEST(Sobol, points_are_those_of_the_definition) {
    std::mt19937 engine(11);
    for (std::uint32_t dimension = 0; dimension < 3; ++dimension)
        for (int i = 0; i < 20'000; ++i) {
            const std::uint32_t index = i < 10'000 ? std::uint32_t(i) : engine();
            ASSERT_EQ(sobol_bits(index, dimension), find_sobol_by_definition(index, dimension))
                << index << " in dimension " << dimension;
        }
}

using Sampler = std::function<std::uint32_t(std::uint32_t index, std::uint32_t dimension)>;

// Every elementary interval of area 2^-m holds exactly one of 2^m points.
bool is_net(const Sampler& sample, std::uint32_t first, std::uint32_t m, std::uint32_t x_bits) {
    const std::uint32_t y_bits = m - x_bits;
    std::vector<std::uint8_t> seen(1u << m);
    for (std::uint32_t i = first; i < first + (1u << m); ++i) {
        const auto keep = [](std::uint32_t bits, std::uint32_t n) { return n == 0 ? 0 : bits >> (32 - n); };
        if (seen[keep(sample(i, 0), x_bits) << y_bits | keep(sample(i, 1), y_bits)]++)
            return false;
    }
    return true;
}

void expect_nets(const Sampler& sample) {
    for (std::uint32_t m = 0; m <= 12; ++m)
        for (std::uint32_t block : {0u, 1u, 7u, 1000u})
            for (std::uint32_t x_bits = 0; x_bits <= m; ++x_bits)
                EXPECT_TRUE(is_net(sample, block << m, m, x_bits)) << m << ' ' << block << ' ' << x_bits;
}

TEST(Sobol, first_two_dimensions_form_nets) {
    expect_nets(sobol_bits);
}

TEST(Sobol, scrambled_dimensions_still_form_nets) {
    for (std::uint32_t seed : {0u, 1u, SEED})
        expect_nets([seed](std::uint32_t i, std::uint32_t dimension) { return sample_sobol(seed, i, dimension); });
}

TEST(Sobol, third_dimension_is_stratified_scrambled_or_not) {
    for (std::uint32_t m : {4u, 8u, 12u}) {
        std::vector<int> plain(1u << m), scrambled(1u << m);
        for (std::uint32_t i = 3u << m; i < 4u << m; ++i) {
            ++plain[sobol_bits(i, 2) >> (32 - m)];
            ++scrambled[sample_sobol(SEED, i, 2) >> (32 - m)];
        }
        EXPECT_EQ(plain, std::vector<int>(1u << m, 1));
        EXPECT_EQ(scrambled, std::vector<int>(1u << m, 1));
    }
}

TEST(Sobol, scrambling_differs_by_seed_and_dimension) {
    int same_seed = 0, same_dimension = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        same_seed += sample_sobol(1, i, 0) == sample_sobol(2, i, 0);
        same_dimension += sample_sobol(1, i, 0) == sample_sobol(1, i, 1);
    }
    EXPECT_LT(same_seed, 3);
    EXPECT_LT(same_dimension, 3);
}

// Over many seeds a scrambled point may lie anywhere.
TEST(Sobol, scrambled_point_is_uniform_over_seeds) {
    for (std::uint32_t index : {0u, 1u, 4095u})
        for (std::uint32_t dimension = 0; dimension < 3; ++dimension) {
            std::vector<std::uint32_t> counts(256);
            for (std::uint32_t seed = 0; seed < 1u << 16; ++seed)
                ++counts[sample_sobol(seed, index, dimension) >> 24];
            EXPECT_LT(std::abs(measure_unevenness(counts)), UNLIKELY) << index << " in dimension " << dimension;
        }
}

} // namespace
} // namespace photonloupe::test
