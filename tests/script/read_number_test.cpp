// SPDX-License-Identifier: Apache-2.0
// Numbers as scripts write them.
#include "script/read/read_number.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace photonloupe::script::tests {
namespace {

TEST(ReadNumber, integers_are_decimal_or_hexadecimal) {
    EXPECT_EQ(read_number("42;").length, 2u);
    EXPECT_TRUE(read_number("42").is_integer);
    EXPECT_EQ(read_number("010").integer, 10u); // no octal
    EXPECT_EQ(read_number("0xfF").integer, 255u);
    EXPECT_EQ(read_number("0XFFFFFFFF").value, -1.0);
    EXPECT_FALSE(read_number("0x100000000").problem.empty());
    EXPECT_FALSE(read_number("0x").problem.empty());
    EXPECT_FALSE(read_number("0xg").problem.empty());
}

TEST(ReadNumber, integers_past_thirty_two_bits_are_real) {
    EXPECT_TRUE(read_number("2147483647").is_integer);
    EXPECT_TRUE(read_number("2147483648").is_integer); // for the sake of its negative
    EXPECT_FALSE(read_number("2147483649").is_integer);
    EXPECT_EQ(read_number("99999999999999999999").value, double(1e20f));
}

TEST(ReadNumber, reals_have_a_point_or_an_exponent) {
    EXPECT_FALSE(read_number("1.").is_integer);
    EXPECT_EQ(read_number("1.").length, 2u);
    EXPECT_EQ(read_number(".5").value, 0.5);
    EXPECT_EQ(read_number("2.5e-3x").problem, "a number can't run into letters");
    EXPECT_EQ(read_number("1e3").value, 1000.0);
    EXPECT_EQ(read_number("1E+2").value, 100.0);
    EXPECT_EQ(read_number("1e").length, 2u);
    EXPECT_FALSE(read_number("1e").problem.empty());
    EXPECT_EQ(read_number("1.5.2").length, 3u);
}

TEST(ReadNumber, reals_are_rounded_once) {
    EXPECT_EQ(float(read_number("0.1").value), 0.1f);
    EXPECT_EQ(float(read_number("16777217.0").value), 16777216.0f);
    EXPECT_EQ(float(read_number("1.00000017881393432617187499").value), 1.0000001f); // twice: 1.0000002
    EXPECT_EQ(float(read_number("3.4028235e38").value), std::numeric_limits<float>::max());
    EXPECT_FALSE(read_number("3.5e38").problem.empty());
    EXPECT_FALSE(read_number("1e400").problem.empty());
    EXPECT_EQ(read_number("1e-400").value, 0.0);
    EXPECT_EQ(read_number("0." + std::string(400, '0') + "1").value, 0.0);
    EXPECT_EQ(float(read_number("1e-45").value), std::numeric_limits<float>::denorm_min());
}

} // namespace
} // namespace photonloupe::script::tests
