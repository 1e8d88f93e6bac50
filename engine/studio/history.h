// SPDX-License-Identifier: Apache-2.0
// Undo and redo: the states before each command. What follows from a state is made again by the work it asks for.
#pragma once

#include <deque>
#include <string>

#include "studio/state.h"

namespace photonloupe::studio {

class History {
public:
    // To be called before `state` changes. Changes of one name within one gesture (a drag, a held key) are one command.
    void record(const std::string& name, const StudioState& state);
    // The next change of the same name is a command of its own.
    void end_gesture() { m_is_open = false; }

    // Exchange the state for the one before, or after; false when there is none.
    bool undo(StudioState& state) { return step(state, m_done, m_undone); }
    bool redo(StudioState& state) { return step(state, m_undone, m_done); }

    std::string undo_name() const { return m_done.empty() ? "" : m_done.back().name; }
    std::string redo_name() const { return m_undone.empty() ? "" : m_undone.back().name; }
    std::size_t size() const { return m_done.size(); }
    void clear();

private:
    struct Entry {
        std::string name;
        StudioState state;
    };
    bool step(StudioState& state, std::deque<Entry>& from, std::deque<Entry>& to);

    std::deque<Entry> m_done;
    std::deque<Entry> m_undone;
    bool m_is_open = false;
};

} // namespace photonloupe::studio
