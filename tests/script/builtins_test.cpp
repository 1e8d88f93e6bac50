// SPDX-License-Identifier: Apache-2.0
// The table of predefined calls is complete and says what is so.
#include "script/builtins.h"

#include <set>

#include <gtest/gtest.h>

#include "script/script_files.h"

namespace photonloupe::test {
namespace {

using namespace script;

TEST(ScriptBuiltins, have_a_row_for_every_id) {
    std::set<BuiltinId> ids;
    std::set<std::string_view> names, functions;
    for (const Builtin& builtin : list_builtins()) {
        EXPECT_TRUE(ids.insert(builtin.id).second || builtin.id == BuiltinId::other) << builtin.name;
        EXPECT_TRUE(names.insert(builtin.name).second) << builtin.name;
        EXPECT_TRUE(functions.insert(builtin.glsl).second) << builtin.glsl;
        EXPECT_TRUE(builtin.signature.starts_with(std::string(builtin.name) + '(')) << builtin.name;
        EXPECT_TRUE(builtin.doc.ends_with('.')) << builtin.name;
        EXPECT_LE(builtin.required, builtin.arguments.size()) << builtin.name;
    }
    EXPECT_EQ(ids.size(), std::size_t(BuiltinId::other) + 1);
}

TEST(ScriptBuiltins, have_second_names) {
    EXPECT_EQ(find_builtin("getNumVertices"), find_builtin("getNumPathVertices"));
    EXPECT_EQ(find_builtin("setPhotonColorEncoding"), find_builtin("setPhotonColourEncoding"));
    EXPECT_EQ(find_builtin("getnumvertices"), nullptr);
}

TEST(ScriptBuiltins, name_their_glsl_function_after_themselves) {
    EXPECT_EQ(find_builtin("atan2")->glsl, "script_atan2");
    EXPECT_EQ(find_builtin("getPathVertex")->glsl, "script_get_path_vertex");
    EXPECT_EQ(find_builtin("resetPCA2D")->glsl, "script_reset_pca_2d");
    EXPECT_EQ(find_builtin("int")->glsl, "script_int");
    for (const Builtin& builtin : list_builtins())
        for (const char c : builtin.glsl)
            EXPECT_NE(std::string_view("abcdefghijklmnopqrstuvwxyz0123456789_").find(c), std::string_view::npos);
}

TEST(ScriptBuiltins, without_effect_have_a_reference_function) {
    for (const Builtin& builtin : list_builtins()) {
        const bool is_special = builtin.id == BuiltinId::random || builtin.id == BuiltinId::length;
        EXPECT_EQ(builtin.reference != nullptr, builtin.effect == Effect::none && !is_special) << builtin.name;
        if (builtin.result == Result::as_arguments) {
            EXPECT_NE(builtin.reference_integer, nullptr) << builtin.name;
        }
    }
}

TEST(ScriptBuiltins, can_all_be_called_as_their_signature_shows) {
    for (const Builtin& builtin : list_builtins()) {
        for (std::size_t count : {std::size_t(builtin.required), builtin.arguments.size()}) {
            std::string call(builtin.name);
            call += '(';
            for (std::size_t i = 0; i < count; ++i) {
                const Argument argument = builtin.arguments[i];
                call += i == 0 ? "" : ", ";
                call += argument == Argument::list             ? "nn"
                        : argument == Argument::text           ? "\"t\""
                        : argument == Argument::dimension      ? "3"
                        : builtin.id == BuiltinId::histogram   ? std::to_string(i)
                        : argument == Argument::uniform_number ? std::to_string(i)
                                                               : "1";
            }
            const std::string declared =
                builtin.id == BuiltinId::declare_photon_parameter ? "" : "declarePhotonParameter(3, 0, 1); ";
            const std::string target = builtin.result == Result::list ? "mm = " : "";
            check_accepted("nn = getKNN(0); " + declared + target + call + ");");
        }
    }
}

TEST(ScriptBuiltins, decide_what_columns_a_script_reads) {
    EXPECT_EQ(check_accepted("x = 1;").columns, 0u);
    EXPECT_EQ(check_accepted("x = getPathVertex(0, 0, X);").columns, COLUMN_PATH_STARTS | COLUMN_PATH_VERTICES);
    EXPECT_EQ(check_accepted("x = f(0); function f(i) { return getPhotonPower(i, 0); }").columns, COLUMN_POWER);
    EXPECT_EQ(check_accepted("x = 1; function f(i) { return getPhotonPower(i, 0); }").columns, 0u);
    EXPECT_EQ(check_accepted("x = getPhotonParameter(0, X);").columns, COLUMN_POSITION);
    EXPECT_EQ(check_accepted("x = getPhotonParameter(0, 3);").columns, COLUMN_PARAMETERS);
    EXPECT_EQ(check_accepted("d = 3; d++; x = getPhotonParameter(0, d);").columns, COLUMN_PARAMETERS | COLUMN_POSITION);
}

} // namespace
} // namespace photonloupe::test
