// SPDX-License-Identifier: Apache-2.0
// Emitted GLSL at the edges: strange names and comments, depth, length, what is left out, what never recompiles.
#include "script/emit/emit.h"

#include <string>

#include <gtest/gtest.h>

#include "gpu/compile_glsl.h"
#include "gpu/kernel_source.h"
#include "script/compile_script.h"
#include "support/shared_device.h"

namespace photonloupe::script {
namespace {

std::unique_ptr<CompiledScript> compile(const std::string& text) {
    auto script = compile_script({"test \"\\\n.photon", text});
    EXPECT_FALSE(script->has_errors) << format_diagnostics(script->program.source, script->diagnostics);
    for (std::size_t i = 0; i < script->plan.loops.size(); ++i)
        EXPECT_TRUE(script->plan.loops[i].is_parallel)
            << format_diagnostics(script->program.source, script->plan.loops[i].reasons);
    return script;
}

// Of the only pass; it compiles.
EmittedPass emit(const std::string& text) {
    const auto script = compile("declarePhotonParameter(3, 0, 1); n = getNumPhotons();\n" + text);
    if (script->passes.size() != 1) {
        ADD_FAILURE() << script->passes.size() << " passes";
        return {};
    }
    const EmittedPass pass = script->passes[0];
    EXPECT_FALSE(pass.too_long);
    test::get_device(); // its environment names the folder of shaders
    EXPECT_NO_THROW(gpu::compile_glsl(
        gpu::declare_bindings(gpu::expand_source({"script", 64, {}, {}, pass.glsl}), {}, 0), "script"))
        << pass.glsl;
    return pass;
}

std::string in_loop(const std::string& body) {
    return "for (i = 0; i < n; i++) {\n" + body + "\n}";
}

bool has(const EmittedPass& pass, const std::string& text) {
    return pass.glsl.find(text) != std::string::npos;
}

std::string repeat(const std::string& text, int times) {
    std::string result;
    for (int i = 0; i < times; ++i)
        result += text;
    return result;
}

TEST(Emit, counters_along_the_photons_path_are_not_checked) {
    const char* const unchecked[] = {
        "for (j = 0; j < getNumPathVertices(i); j++) s += getPathVertex(i, j, X);",
        "m = getNumPathVertices(i); for (j = 1; j < m - 1; j++) s += getPathVertex(i, j + 1, X) - getPathVertex(i, j - "
        "1, Y);",
        "for (int j = 2; j <= getNumPathVertices(i) - 1; j += 1) s += getPathNormal(i, j - 2, Z);",
    };
    const char* const checked[] = {
        "for (j = 0; j <= getNumPathVertices(i); j++) s += getPathVertex(i, j, X);",
        "for (j = 0; j < getNumPathVertices(i); j++) s += getPathVertex(i, j - 1, X);",
        "for (j = 0; j < getNumPathVertices(i); j++) s += getPathVertex(i, j + 1, X);",
        "for (j = 0; j < getNumPathVertices(0); j++) s += getPathVertex(i, j, X);",
        "m = getNumPathVertices(i); if (i > 3) m = 9; for (j = 0; j < m; j++) s += getPathVertex(i, j, X);",
        "for (j = -1; j < getNumPathVertices(i); j++) s += getPathVertex(i, j, X);",
        "for (j = 0; j < getNumPathVertices(i); j++) { s += getPathVertex(i, j, X); if (s > 1) j = 7; }",
        "k = 0; for (j = 0; j < getNumPathVertices(i); j++) { k++; s += getPathVertex(i, k, X); }",
        "for (j = 0; j < getNumPathVertices(i); j++) s += 1; s += getPathVertex(i, j, X);",
        "for (j = 0; j < getNumPathVertices(i); j++) s += getPathVertex(0, j, X);",
    };
    for (const char* const text : unchecked)
        EXPECT_FALSE(
            has(emit(in_loop(std::string("s = 0.0; ") + text + " setPhotonParameter(i, 3, s);")), "find_place(v_"))
            << text;
    for (const char* const text : checked)
        EXPECT_TRUE(has(emit(in_loop(std::string("s = 0.0; ") + text + " setPhotonParameter(i, 3, s);")), "find_place"))
            << text;
}

TEST(Emit, names_that_glsl_reserves_are_harmless) {
    emit(in_loop("vec3 = 2; main = 3; gl_Position = 4; photon = 5; a__b = 6; _ = 7; a_ub = 8; __ = 9; settings = 10; "
                 "ZERO = 11; layout = 12; x_is_set = 13; texture = 14; setPhotonParameter(i, 3, vec3 + main + "
                 "gl_Position + "
                 "photon + a__b + _ + a_ub + __ + settings + ZERO + layout + x_is_set + texture);"));
    emit("function run_body(a__) { return a__; } function main(x) { return run_body(x); } function push_point() { "
         "return 3; }\n" +
         in_loop("setPhotonParameter(i, 3, main(i) + run_body(2) + push_point());"));
    emit(in_loop(std::string(3000, 'x') + " = 1; " + std::string(2999, 'x') + " = 2; setPhotonParameter(i, 3, " +
                 std::string(3000, 'x') + ");"));
}

TEST(Emit, comments_hold_nothing_that_matters) {
    emit(in_loop("x = 1; /* \\\n*/ y = 2; // #include \"nothing\" \\\\ \t \x01 é */ \\\n setPhotonParameter(i, 3, "
                 "x); // ?\n z = 3; "
                 "// \\\n print(\"\\\\ */ // \\\" \", x);"));
}

TEST(Emit, deep_scripts_compile) {
    emit(in_loop("x = " + repeat("(1 + ", 55) + "i" + repeat(")", 55) + "; setPhotonParameter(i, 3, x);"));
    emit(in_loop("x = i" + repeat(" + i * 0.5", 120) + "; setPhotonParameter(i, 3, x);"));
    emit(in_loop("x = i" + repeat(" && i", 200) + "; y = i" + repeat(" || (x = i) > 3", 100) +
                 "; "
                 "setPhotonParameter(i, 3, x + y);"));
    emit(in_loop("x = " + repeat("i > 3 ? 1.5 : ", 60) + "2; setPhotonParameter(i, 3, x);"));
    emit(in_loop("x = " + repeat("sin(", 50) + "i" + repeat(")", 50) + "; setPhotonParameter(i, 3, x);"));
    emit(in_loop("float a[3]; x = " + repeat("a[0 + ", 40) + "i % 3" + repeat("]", 40) +
                 "; setPhotonParameter(i, "
                 "3, x);"));
    emit(in_loop("x = 0; " + repeat("for (j = 0; j < 2; j++) {", 50) + "x += 1;" + repeat("}", 50) +
                 " "
                 "setPhotonParameter(i, 3, x);"));
    emit(in_loop(repeat("if (i > 3) {", 55) + "x = 1;" + repeat("}", 55)));
    std::string arms = "if (i == 0) x = 0;";
    for (int arm = 1; arm < 200; ++arm)
        arms += " else if (i == " + std::to_string(arm) + ") x = " + std::to_string(arm) + ";";
    emit(in_loop(arms + " else x = 3; setPhotonParameter(i, 3, x);"));
}

TEST(Emit, numbers_are_read_back_bit_by_bit) {
    const EmittedPass pass = emit(in_loop("x = i * 0.1 + i * 3.4028234e38 + i * 1e-45 + i * 1e-38 + i * 16777217 + "
                                          "i * 1e10 + i * 0x7fffffff; "
                                          "y = i - 2147483647 - 1; setPhotonParameter(i, 3, x + y);"));
    EXPECT_TRUE(has(pass, "* 0.1"));
    EXPECT_TRUE(has(pass, "3.4028235e+38"));
    EXPECT_TRUE(has(pass, "uintBitsToFloat(0x1u)"));
}

TEST(Emit, a_pass_that_grows_too_long_is_refused) {
    const std::string line = "x = sin(i * 0.5) + cos(i * 0.25) + x * 2 + getPathVertex(i, i % 3, X);";
    const auto script = compile_script({"test", "for (i = 0; i < getNumPhotons(); i++) { x = 0; "
                                                "" + repeat(line, 800) +
                                                    "}"});
    ASSERT_TRUE(script->has_errors);
    EXPECT_EQ(script->diagnostics[0].code, "E072");
    EXPECT_NE(script->diagnostics[0].note.find("split"), std::string::npos);
}

TEST(Emit, exposed_values_are_no_part_of_the_text) {
    const std::string head = "a = ", tail = ";\nexpose a range 0, 10\n" + in_loop("setPhotonParameter(i, 3, a * i);");
    const EmittedPass pass = emit(head + "2.5" + tail);
    EXPECT_EQ(pass.glsl, emit(head + "7.25" + tail).glsl);
    ASSERT_EQ(pass.uniforms.size(), 1u);
    EXPECT_EQ(pass.uniform_word_count, 1u);
}

TEST(Emit, constants_are_literals) {
    const EmittedPass pass = emit("GAMMA = 3; k = 7;\n" + in_loop("setPhotonParameter(i, GAMMA, k * "
                                                                  "getPhotonPosition(i, Y) + E);"));
    EXPECT_TRUE(pass.uniforms.empty());
    EXPECT_TRUE(has(pass, "7.0 * read_position(v_i).y + 2.7182817"));
}

TEST(Emit, only_buffers_that_are_used_are_bound) {
    const EmittedPass pass = emit(in_loop("x = getPhotonPower(i, 0);"));
    std::vector<std::string> names;
    for (const gpu::BindingDeclaration& binding : gpu::expand_source({"script", 64, {}, {}, pass.glsl}).bindings)
        names.push_back(binding.name);
    EXPECT_EQ(names, (std::vector<std::string>{"status_words", "fault_words", "power_object"}));
    EXPECT_TRUE(pass.sites.empty());
}

TEST(Emit, checks_are_left_out_where_nothing_can_fail) {
    const EmittedPass pass = emit(in_loop("float c[4]; c[2] = 1; x = c[3] + getPhotonNormal(i, Z); c[1] += x; "
                                          "setPhotonColourEncoding(i, x, c[1], 1);"));
    EXPECT_TRUE(pass.sites.empty()) << pass.glsl;
}

TEST(Emit, reductions_of_arrays_cannot_be_taken_back_unless_loops_have_fuel) {
    const std::string before = "int h[4]; s = 0;\n", after = "\nprint(\"s\", s, h[0]);";
    EXPECT_TRUE(emit(before + in_loop("h[i % 4]++; s += 1;") + after).can_miss_photons);
    EXPECT_FALSE(emit(before + in_loop("for (j = 0; j < 3; j++) h[j]++;") + after).can_miss_photons);
    EXPECT_TRUE(emit(before + in_loop("for (j = 0; j < 3; j++) s += 1;") + after).can_miss_photons);
    EXPECT_TRUE(emit(before + in_loop("x = i; while (x > 1) { x /= 2; h[i % 4]++; }") + after).can_miss_photons);
}

} // namespace
} // namespace photonloupe::script
