// SPDX-License-Identifier: Apache-2.0
// A recursive mutex that is handed on in the order it was asked for: a frame waits for one chunk of long work, not for
// all of it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

namespace photonloupe::gpu {

class TurnMutex {
public:
    void lock() {
        std::unique_lock guard(m_guard);
        if (m_depth > 0 && m_owner == std::this_thread::get_id()) {
            ++m_depth;
            return;
        }
        const std::uint64_t turn = m_next_turn++;
        m_changed.wait(guard, [&] { return m_depth == 0 && m_turn == turn; });
        m_owner = std::this_thread::get_id();
        m_depth = 1;
    }

    void unlock() {
        std::lock_guard guard(m_guard);
        if (--m_depth > 0)
            return;
        ++m_turn;
        m_changed.notify_all();
    }

private:
    std::mutex m_guard;
    std::condition_variable m_changed;
    std::thread::id m_owner;
    std::uint64_t m_depth = 0;
    std::uint64_t m_next_turn = 0; // of who asks next
    std::uint64_t m_turn = 0;      // of who may go on
};

} // namespace photonloupe::gpu
