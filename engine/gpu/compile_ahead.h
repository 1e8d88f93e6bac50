// SPDX-License-Identifier: Apache-2.0
// Compiles kernels in background threads before they are asked for. It fills caches and hands over finished kernels,
// and never touches data: results are the same with and without it.
//
// Most drivers compile where a pipeline is made: that is done on the device itself. The software device compiles at the
// first dispatch, in the thread of its only queue: there each background thread has a device of its own and dispatches
// no workgroups; the first use finds the machine code in the driver's cache on disk.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "gpu/device.h"
#include "gpu/kernel_source.h"

namespace photonloupe::gpu {

class CompileAhead {
public:
    explicit CompileAhead(Device::Impl& device);
    // Forgets what waits, and waits for the kernels under way: a compiler cannot be interrupted.
    ~CompileAhead();
    CompileAhead(const CompileAhead&) = delete;
    CompileAhead& operator=(const CompileAhead&) = delete;

    // In this order, and before all that waits: a stage that begins needs its kernels sooner than what was expected to
    // follow. Those that were compiled before, or failed, are left out.
    void add(const std::vector<KernelSource>& sources);
    // Asked before a kernel is built for use: waits for a thread that is at it, or takes it from those that wait.
    void claim(const KernelSource& source);
    // For a process that is about to end: nothing more is begun. The compiler's globals must not go while a thread is
    // in it; a kernel that takes longer is abandoned, and with it what would be done after exit().
    static void stop_all();
    bool is_abandoned() const { return m_is_abandoned; }
    // Waits until nothing is left to do; for tests.
    void finish();

private:
    struct Register;
    struct Job {
        std::string key;
        KernelSource source;
    };
    void forget_waiting();
    void stop();
    void work();
    void compile(const KernelSource& source, std::unique_ptr<Device>& rehearsal);

    Device::Impl& m_device;
    bool m_rehearses; // the driver compiles at the first dispatch
    bool m_is_on;
    std::mutex m_mutex; // of all below
    std::condition_variable m_changed;
    std::deque<Job> m_waiting;
    std::set<std::string> m_running, m_known;
    std::vector<std::thread> m_threads;
    bool m_ends = false, m_is_registered = false;
    bool m_is_abandoned = false; // a thread still needs the device: neither is destroyed
};

} // namespace photonloupe::gpu
