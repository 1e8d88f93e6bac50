// SPDX-License-Identifier: Apache-2.0
// Does the studio's work: in a thread while frames go on, or in the frame itself.
#pragma once

#include <atomic>
#include <thread>

#include "studio/stages.h"
#include "studio/studio.h"

namespace photonloupe::studio {

class Worker {
public:
    Worker(Studio& studio, Host host, bool is_threaded);
    // Stops the job and waits for it.
    ~Worker() { close(); }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    bool is_busy() const { return m_is_busy; }
    // Begins the next job, if one waits and none runs; true: it has been done, and a frame should show it. `progress`
    // is asked where the caller waits for it.
    bool take_turn(const Progress& progress);
    void close();

    Stages& stages() { return m_stages; }
    const Stages& stages() const { return m_stages; }
    // Jobs begun so far, by kind.
    const std::map<std::string, std::uint64_t>& counts() const { return m_counts; }

private:
    void work(const Job& job, const Progress& progress);

    Studio& m_studio;
    Stages m_stages;
    bool m_is_threaded;
    std::thread m_thread;
    std::atomic<bool> m_is_busy = false;
    std::map<std::string, std::uint64_t> m_counts; // of the thread that takes turns
};

} // namespace photonloupe::studio
