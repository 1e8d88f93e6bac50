// SPDX-License-Identifier: Apache-2.0
// What can go wrong while a script runs: NaN (integers: 0) results, writes are dropped, and the report says where.
#include <cmath>

#include <gtest/gtest.h>

#include "script/interpret.h"

namespace photonloupe::script::tests {
namespace {

struct Case {
    Fault kind;
    const char* statement; // sets r
    bool is_integer = false;
    std::int32_t integer = 0;
};

// `n` is 8, the number of photons, which the checker does not know; photon 3 has three vertices.
const Case CASES[] = {
    {Fault::unset_variable, "if (n > 100) u = 1.5; r = u;"},
    {Fault::unset_variable, "if (n > 100) u = 1; r = u;", true},
    {Fault::array_index, "float a[4]; r = a[n];"},
    {Fault::array_index, "float a[4]; a[n - 9] = 1; r = a[n - 9];"},
    {Fault::list_index, "nn = getKNN(0, 3); r = nn[n];", true},
    {Fault::photon_index, "r = getPhotonPosition(n, X);"},
    {Fault::photon_index, "r = getPhotonPosition(-n, X);"},
    {Fault::photon_index, "r = getNumPathVertices(n);", true},
    {Fault::photon_index, "r = getPhotonEmitter(n);", true},
    {Fault::photon_index, "nn = getKNN(n, 3); r = length(nn);", true},
    {Fault::vertex_index, "r = getPathVertex(3, n, X);"},
    {Fault::vertex_index, "r = getPathNormal(3, 3, X);"},
    {Fault::vertex_index, "r = getPathObject(3, n - 9);", true},
    {Fault::axis_index, "r = getPhotonNormal(3, n);"},
    {Fault::axis_index, "r = getPathVertex(3, 1, n);"},
    {Fault::dimension_index, "r = getPhotonParameter(3, n);"},
    {Fault::eigen_index, "r = getPCAEigenvalue(0);"},
    {Fault::eigen_index, "pushPCA2D(0, 1); pushPCA2D(1, 0); decomposePCA2D(); r = getPCAEigenvector(0, Z);"},
    {Fault::not_integral, "h = n / 3; r = getPhotonPosition(h, X);"},
    {Fault::not_integral, "h = 0 * log(n - 9); float a[4]; r = a[h];"},
    {Fault::not_integral, "h = n / 0.0; r = getPathVertex(3, h, X);"},
    {Fault::modulo_by_zero, "z = n - 8; r = n % z;", true},
    {Fault::modulo_by_zero, "z = n - 8; r = mod(n, z);", true},
    {Fault::does_not_fit, "r = int(n * 1e9);", true, 2147483647},
    {Fault::does_not_fit, "r = floor(n * -1e9);", true, -2147483647 - 1},
    {Fault::does_not_fit, "r = round(sqrt(n - 9));", true},
    {Fault::does_not_fit, "r = pow(n, 11);", true, 2147483647},
    {Fault::no_value, "r = f(n); function f(x) { if (x < 0) return 0.5; }"},
    {Fault::no_value, "r = f(n); function f(x) { while (x > 0) { if (x < 4) return 1; break; } }", true},
    {Fault::query, "nn = getKNN(0, n - 8); r = length(nn);", true},
    {Fault::query, "nn = getKNN(0, n * 1000); r = length(nn);", true},
    {Fault::query, "nn = getConstrainedKNN(0, 3, n - 9); r = length(nn);", true},
    {Fault::histogram_range, "histogram(\"h\", 1, n, 8); r = 0;", true},
    {Fault::histogram_range, "histogram(\"h\", 1, 0, 1, n - 8); r = 0;", true},
    {Fault::declaration, "declarePhotonParameter(n - 6, 0, 1); r = 0;", true},
};

TEST(InterpreterFaults, give_nan_or_0_in_uniform_code_and_are_reported_once) {
    for (const Case& one : CASES) {
        const Ran ran = interpret("n = getNumPhotons(); " + std::string(one.statement));
        ASSERT_EQ(ran.errors, "") << one.statement;
        const FaultReport* const fault = ran.find_fault(one.kind);
        ASSERT_TRUE(fault) << one.statement;
        EXPECT_EQ(fault->count, 1u) << one.statement;
        EXPECT_EQ(fault->first_photon, NO_PHOTON) << one.statement;
        if (one.is_integer)
            EXPECT_EQ(ran.integer("r"), one.integer) << one.statement;
        else
            EXPECT_TRUE(std::isnan(ran.real("r"))) << one.statement;
    }
}

TEST(InterpreterFaults, count_photons_in_loops_and_name_the_first) {
    for (const Case& one : CASES) {
        if (one.kind == Fault::declaration)
            continue;
        std::string body = one.statement, functions;
        if (const std::size_t at = body.find("function"); at != std::string::npos) {
            functions = body.substr(at);
            body.erase(at);
        }
        const std::string head = "n = getNumPhotons(); for (i = 0; i < n; i++) { if (i < 2 || i == 7) continue; ";
        const Ran ran = interpret(head + body + " } " + functions);
        ASSERT_EQ(ran.errors, "") << one.statement;
        const FaultReport* const fault = ran.find_fault(one.kind);
        ASSERT_TRUE(fault) << one.statement;
        EXPECT_EQ(fault->count, 5u) << one.statement;
        EXPECT_EQ(fault->first_photon, 2u) << one.statement;
    }
}

TEST(InterpreterFaults, stand_at_the_expression_that_is_wrong) {
    const std::string text = "n = getNumPhotons(); float a[4]; x = 1 + a[n + 2] * 3;";
    const Ran ran = interpret(text);
    const FaultReport* const fault = ran.find_fault(Fault::array_index);
    ASSERT_TRUE(fault);
    EXPECT_EQ(text.substr(fault->site.span.begin, fault->site.span.end - fault->site.span.begin), "n + 2");
}

TEST(InterpreterFaults, drop_writes) {
    Ran ran = interpret(R"(
        n = getNumPhotons(); declarePhotonParameter(3, 0, 1);
        float a[2]; a[n] = 5; a[n] += 5; a[n]++;
        setPhotonParameter(n, 3, 0.5); setPhotonColourEncoding(-n, 1, 1, 1);
        d = 3; d += n - 7; setPhotonParameter(0, d, 0.5);
        d -= 4; setPhotonParameter(0, d, 0.5);
    )");
    ASSERT_EQ(ran.errors, "");
    EXPECT_EQ(ran.real("a", 0), 0.0f);
    EXPECT_EQ(ran.real("a", 1), 0.0f);
    EXPECT_TRUE(is_unset(ran.outputs.columns.read_parameter(0, 0)));
    EXPECT_FALSE(ran.outputs.columns.has_colors());
    EXPECT_EQ(ran.find_fault(Fault::photon_index)->count, 1u);
    EXPECT_TRUE(ran.find_fault(Fault::dimension_index));
}

TEST(InterpreterFaults, are_none_where_floats_are_whole) {
    const Ran ran = interpret(R"(
        h = 4 / 2; float a[4]; a[h] = 7; x = a[h] + getPhotonPosition(h, h / 2) + getPathVertex(h, h / 2, 0 * h);
        nn = getKNN(h, h); y = nn[h / 2];
    )");
    ASSERT_EQ(ran.errors, "");
    EXPECT_TRUE(ran.outputs.faults.empty());
    EXPECT_EQ(ran.real("x"), 7.0f + 20.0f + 2.0f);
    EXPECT_EQ(ran.integer("y"), 4);
}

TEST(InterpreterFaults, of_ieee_arithmetic_are_none) {
    const Ran ran = interpret("n = getNumPhotons(); a = n / 0; b = 0 / (n - 8); c = sqrt(-n); d = log(0 * n); "
                              "e = acos(n);");
    EXPECT_TRUE(ran.outputs.faults.empty());
    EXPECT_TRUE(std::isinf(ran.real("a")));
    for (const char* const name : {"b", "c", "e"})
        EXPECT_TRUE(std::isnan(ran.real(name))) << name;
    EXPECT_EQ(ran.real("d"), -INFINITY);
}

} // namespace
} // namespace photonloupe::script::tests
