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

bool History::undo(StudioState& state) {
    if (m_done.empty())
        return false;
    m_undone.push_back({m_done.back().name, std::move(state)});
    state = std::move(m_done.back().state);
    m_done.pop_back();
    m_is_open = false;
    return true;
}

bool History::redo(StudioState& state) {
    if (m_undone.empty())
        return false;
    m_done.push_back({m_undone.back().name, std::move(state)});
    state = std::move(m_undone.back().state);
    m_undone.pop_back();
    m_is_open = false;
    return true;
}

void History::clear() {
    m_done.clear();
    m_undone.clear();
    m_is_open = false;
}

} // namespace photonloupe::studio
