// SPDX-License-Identifier: Apache-2.0
// Keys by name, polygons, and the program that is copied.
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <imgui.h>

#include "core/error.h"
#include "studio/commands.h"
#include "studio/python_script.h"
#include "studio/scatter_panel.h"

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

TEST(Polygon, square_holds_what_is_within) {
    const std::vector<glm::vec2> square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    EXPECT_TRUE(is_within(square, {1, 1}));
    EXPECT_FALSE(is_within(square, {3, 1}));
    EXPECT_FALSE(is_within(square, {1, -1}));
}

TEST(Polygon, hollow_is_outside) {
    const std::vector<glm::vec2> letter = {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
    EXPECT_TRUE(is_within(letter, {0.5f, 2}));
    EXPECT_TRUE(is_within(letter, {2.5f, 2}));
    EXPECT_FALSE(is_within(letter, {1.5f, 2}));
}

TEST(Polygon, without_area_it_holds_nothing) {
    EXPECT_FALSE(is_within({}, {0, 0}));
    EXPECT_FALSE(is_within({{1, 1}}, {1, 1}));
    EXPECT_FALSE(is_within({{0, 0}, {2, 2}}, {1, 1}));
}

TEST(Polygon, each_place_belongs_to_one_of_two_neighbours) {
    std::mt19937 engine(1);
    const std::vector<glm::vec2> left = {{0, 0}, {8, 0}, {8, 8}, {0, 8}}, right = {{8, 0}, {16, 0}, {16, 8}, {8, 8}};
    for (int i = 0; i < 200; ++i) {
        const glm::vec2 point(static_cast<float>(engine() % 17), 1 + static_cast<float>(engine() % 6));
        if (point.x < 16)
            EXPECT_NE(is_within(left, point), is_within(right, point)) << point.x << " " << point.y;
    }
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
    state.relax.used.limit = 0;
    const std::string text = write_python(state, {});
    EXPECT_NE(text.find("for _ in range(3):\n    relaxation.step()"), std::string::npos) << text;
    EXPECT_NE(text.find("limit=None"), std::string::npos);
}

} // namespace
} // namespace photonloupe::studio
