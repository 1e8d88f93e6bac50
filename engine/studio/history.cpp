// SPDX-License-Identifier: Apache-2.0
// Keeps the states that undo and redo go to.
#include "studio/history.h"

namespace photonloupe::studio {
namespace {

// Scripts and selections make up a state; their ids are shared between states.
constexpr std::size_t MOST_COMMANDS = 500;

} // namespace

void History::record(const std::string& name, const StudioState& state) {
    if (m_is_open && !m_done.empty() && m_done.back().name == name)
        return;
    m_done.push_back({name, state});
    m_undone.clear();
    m_is_open = true;
    if (m_done.size() > MOST_COMMANDS)
        m_done.pop_front();
}

bool History::step(StudioState& state, std::deque<Entry>& from, std::deque<Entry>& to) {
    if (from.empty())
        return false;
    to.push_back({from.back().name, std::move(state)});
    state = std::move(from.back().state);
    from.pop_back();
    m_is_open = false;
    return true;
}

void History::clear() {
    m_done.clear();
    m_undone.clear();
    m_is_open = false;
}

} // namespace photonloupe::studio
