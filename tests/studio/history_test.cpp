// SPDX-License-Identifier: Apache-2.0
// Undo and redo: changes of one name within a gesture are one command.
#include <gtest/gtest.h>

#include "studio/history.h"

namespace photonloupe::studio {
namespace {

void set_k(History& history, StudioState& state, const char* name, std::uint32_t k) {
    history.record(name, state);
    state.loupe.k = k;
}

TEST(History, undo_and_redo_exchange_states) {
    History history;
    StudioState state;
    state.loupe.k = 1;
    set_k(history, state, "a", 2);
    set_k(history, state, "b", 3);
    EXPECT_EQ(history.undo_name(), "b");
    ASSERT_TRUE(history.undo(state));
    EXPECT_EQ(state.loupe.k, 2u);
    EXPECT_EQ(history.redo_name(), "b");
    ASSERT_TRUE(history.undo(state));
    EXPECT_EQ(state.loupe.k, 1u);
    EXPECT_FALSE(history.undo(state));
    ASSERT_TRUE(history.redo(state));
    ASSERT_TRUE(history.redo(state));
    EXPECT_EQ(state.loupe.k, 3u);
    EXPECT_FALSE(history.redo(state));
}

TEST(History, one_gesture_is_one_command) {
    History history;
    StudioState state;
    state.loupe.k = 1;
    for (std::uint32_t k = 2; k < 10; ++k)
        set_k(history, state, "drag", k);
    EXPECT_EQ(history.size(), 1u);
    history.undo(state);
    EXPECT_EQ(state.loupe.k, 1u);
}

TEST(History, gestures_are_apart) {
    History history;
    StudioState state;
    set_k(history, state, "drag", 2);
    history.end_gesture();
    set_k(history, state, "drag", 3);
    EXPECT_EQ(history.size(), 2u);
}

TEST(History, another_name_within_a_gesture_is_another_command) {
    History history;
    StudioState state;
    set_k(history, state, "a", 2);
    set_k(history, state, "b", 3);
    set_k(history, state, "a", 4);
    EXPECT_EQ(history.size(), 3u);
}

TEST(History, change_after_undo_forgets_what_was_undone) {
    History history;
    StudioState state;
    set_k(history, state, "a", 2);
    history.undo(state);
    set_k(history, state, "a", 5); // not merged into what was undone
    EXPECT_FALSE(history.redo(state));
    EXPECT_EQ(history.size(), 1u);
    history.undo(state);
    EXPECT_EQ(state.loupe.k, StudioState{}.loupe.k);
}

TEST(History, oldest_commands_are_forgotten) {
    History history;
    StudioState state;
    for (std::uint32_t k = 1; k <= 700; ++k) {
        set_k(history, state, "a", k);
        history.end_gesture();
    }
    EXPECT_EQ(history.size(), 500u);
    while (history.undo(state)) {
    }
    EXPECT_EQ(state.loupe.k, 200u);
}

} // namespace
} // namespace photonloupe::studio
