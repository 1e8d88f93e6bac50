// SPDX-License-Identifier: Apache-2.0
// Keys by name, and the program that is copied.
#include <set>

#include <gtest/gtest.h>
#include <imgui.h>

#include "core/error.h"
#include "studio/commands.h"
#include "studio/python_script.h"

namespace photonloupe::studio {
namespace {

TEST(Chord, names_are_keys) {
    EXPECT_EQ(parse_chord("a"), ImGuiKey_A);
    EXPECT_EQ(parse_chord("Z"), ImGuiKey_Z);
    EXPECT_EQ(parse_chord("7"), ImGuiKey_7);
    EXPECT_EQ(parse_chord("ctrl+enter"), ImGuiMod_Ctrl | ImGuiKey_Enter);
    EXPECT_EQ(parse_chord("ctrl+shift+c"), ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_C);
    EXPECT_EQ(parse_chord("?"), ImGuiMod_Shift | ImGuiKey_Slash);
    EXPECT_EQ(parse_chord("alt"), int{ImGuiMod_Alt});
}

TEST(Chord, what_is_no_key_is_refused) {
    for (const char* text :
         {"", "+", "++", "ctrl+", "ctrl++", "hyper+a", "ctrl+enter+a", "enter+ctrl", "ab", "\xc3\xa4"})
        EXPECT_THROW(parse_chord(text), Error) << text;
}

TEST(Commands, have_one_name_and_one_key_each) {
    std::set<std::string_view> names;
    std::set<int> chords;
    for (const Command& command : list_commands()) {
        EXPECT_TRUE(names.insert(command.name).second) << command.name;
        EXPECT_EQ(&find_command(command.name), &command);
        if (!command.keys.empty()) {
            EXPECT_TRUE(chords.insert(parse_chord(command.keys)).second) << command.keys;
        }
    }
    EXPECT_THROW(find_command("make.coffee"), Error);
}

TEST(PythonScript, empty_state_only_imports) {
    EXPECT_EQ(write_python({}, {}), "import photonloupe as pl\n");
}

TEST(PythonScript, quotes_what_is_given) {
    StudioState state;
    state.trace.scene = "/a \"b\"\\\n.gltf";
    const std::string text = write_python(state, {});
    EXPECT_NE(text.find(R"(pl.load_scene("/a \"b\"\\\n.gltf"))"), std::string::npos) << text;
    EXPECT_NE(text.find("relaxed = photons\n"), std::string::npos);
}

TEST(PythonScript, tells_the_steps_that_were_made) {
    StudioState state;
    state.trace.scene = "/a.gltf";
    state.relax.made = 3;
    state.relax.used.limit.reset();
    const std::string text = write_python(state, {});
    EXPECT_NE(text.find("for _ in range(3):\n    relaxation.step()"), std::string::npos) << text;
    EXPECT_NE(text.find("limit=None"), std::string::npos);
}

} // namespace
} // namespace photonloupe::studio
