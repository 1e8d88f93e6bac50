// SPDX-License-Identifier: Apache-2.0
// Background threads that take kernels from a queue: makes their pipelines, or rehearses them on the software device.
#include "gpu/compile_ahead.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <unistd.h>

#include "core/error.h"
#include "gpu/commands.h"
#include "gpu/device_impl.h"
#include "gpu/driver_cache.h"

namespace photonloupe::gpu {
namespace {

// One core is for whoever uses the device; more than three threads wait for memory rather than compile.
constexpr unsigned LARGEST_THREAD_COUNT = 3;
// Slow drivers take half a minute for the longest kernels; after that whoever waits compiles himself.
constexpr std::chrono::seconds LONGEST_WAIT{60};
// Mesa writes a file in a few milliseconds once its thread gets its turn.
constexpr std::chrono::milliseconds LONGEST_WRITE{100}, WRITE_POLL{2};
constexpr std::uint64_t STAND_IN_BYTES = 1024;
// A process that ends does not wait for the compiler.
constexpr std::chrono::milliseconds LONGEST_FAREWELL{50};
// The work at hand comes first; yet whoever waits for a kernel must get it soon on a busy machine too.
constexpr int NICENESS = 5;

bool is_switched_off() {
    const char* value = std::getenv("PHOTONLOUPE_COMPILE_AHEAD"); // 0: only where kernels are used, as on one core
    return std::thread::hardware_concurrency() == 1 || (value && std::strcmp(value, "0") == 0);
}

unsigned choose_thread_count() {
    return std::clamp(std::thread::hardware_concurrency(), 2u, LARGEST_THREAD_COUNT + 1) - 1;
}

// Dispatches no workgroups: the driver compiles before it looks how many there are.
void dispatch_nothing(Device& device, const KernelSource& source) {
    const Kernel& kernel = device.find_kernel(source);
    const Buffer stand_in(device, STAND_IN_BYTES, "stand-in");
    std::vector<Binding> bindings;
    for (const BindingDeclaration& declared : kernel.bindings())
        bindings.push_back({declared.name, stand_in});
    Commands commands(device, "compile ahead");
    const std::byte push{};
    commands.dispatch_bytes(source, bindings, std::span(&push, 1), 0);
    commands.run();
}

void wait_for_write(std::uintmax_t bytes_before) {
    const auto end = std::chrono::steady_clock::now() + LONGEST_WRITE;
    while (measure_driver_cache() == bytes_before && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(WRITE_POLL);
}

} // namespace

// All that have threads; never destroyed, as a device may be a global.
struct CompileAhead::Register {
    std::mutex mutex;
    std::set<CompileAhead*> all;

    static Register& find() {
        static Register& made = *new Register;
        return made;
    }
};

void CompileAhead::stop_all() {
    Register& there = Register::find();
    std::lock_guard lock(there.mutex);
    bool is_abandoned = false;
    for (CompileAhead* one : there.all) {
        one->forget_waiting();
        std::unique_lock lock_one(one->m_mutex);
        one->m_is_abandoned =
            !one->m_changed.wait_for(lock_one, LONGEST_FAREWELL, [&] { return one->m_running.empty(); });
        is_abandoned |= one->m_is_abandoned;
    }
    if (is_abandoned) // the last to be registered is the first to run, before the globals go
        on_exit(
            [](int status, void*) {
                std::fflush(nullptr);
                _exit(status);
            },
            nullptr);
}

CompileAhead::CompileAhead(Device::Impl& device)
    : m_device(device), m_rehearses(device.info.type == "software"),
      m_is_on(!is_switched_off() && (!m_rehearses || !find_driver_cache().empty())) {}

CompileAhead::~CompileAhead() {
    if (m_is_registered) {
        Register& there = Register::find();
        std::lock_guard lock(there.mutex);
        there.all.erase(this);
    }
    stop();
}

void CompileAhead::forget_waiting() {
    std::lock_guard lock(m_mutex);
    m_ends = true;
    m_waiting.clear();
    m_changed.notify_all();
}

void CompileAhead::stop() {
    forget_waiting();
    for (std::thread& thread : m_threads)
        thread.join();
    m_threads.clear();
}

void CompileAhead::add(const std::vector<KernelSource>& sources) {
    if (!m_is_on)
        return;
    std::lock_guard lock(m_mutex);
    if (m_ends)
        return;
    std::deque<Job> jobs;
    for (const KernelSource& source : sources) {
        std::string key = make_key(source);
        const bool waits = std::erase_if(m_waiting, [&](const Job& job) { return job.key == key; }) > 0;
        if (m_known.insert(key).second || waits)
            jobs.push_back({std::move(key), source});
    }
    m_waiting.insert(m_waiting.begin(), jobs.begin(), jobs.end());
    if (!m_waiting.empty() && !m_is_registered) {
        Register& there = Register::find();
        std::lock_guard register_lock(there.mutex);
        there.all.insert(this);
        m_is_registered = true;
    }
    while (m_threads.size() < std::min<std::size_t>(choose_thread_count(), m_waiting.size()))
        m_threads.emplace_back(&CompileAhead::work, this);
    m_changed.notify_all();
}

void CompileAhead::claim(const KernelSource& source) {
    if (!m_is_on)
        return;
    const std::string key = make_key(source);
    bool was_waiting = false;
    {
        std::unique_lock lock(m_mutex);
        m_known.insert(key);
        was_waiting = std::erase_if(m_waiting, [&](const Job& job) { return job.key == key; }) > 0;
        m_changed.wait_for(lock, LONGEST_WAIT, [&] { return !m_running.contains(key); });
    }
    if (was_waiting && m_rehearses)
        mark_compiled(hash_machine_code(m_device, source)); // as it is about to be
}

void CompileAhead::finish() {
    std::unique_lock lock(m_mutex);
    m_changed.wait_for(lock, LONGEST_WAIT, [&] { return m_waiting.empty() && m_running.empty(); });
}

void CompileAhead::work() {
    [[maybe_unused]] const int niceness = nice(NICENESS); // of this thread and those its device starts
    std::unique_ptr<Device> rehearsal;
    std::unique_lock lock(m_mutex);
    for (;;) {
        m_changed.wait(lock, [&] { return m_ends || !m_waiting.empty(); });
        if (m_ends)
            return;
        const Job job = std::move(m_waiting.front());
        m_waiting.pop_front();
        m_running.insert(job.key);
        lock.unlock();
        try {
            compile(job.source, rehearsal);
        } catch (const std::exception&) {
            // The kernel's first use meets the same error where it can be reported.
        }
        lock.lock();
        m_running.erase(job.key);
        m_changed.notify_all();
    }
}

void CompileAhead::compile(const KernelSource& source, std::unique_ptr<Device>& rehearsal) {
    if (!m_rehearses) {
        auto kernel = std::make_unique<Kernel>(m_device, source);
        kernel->find_variant(0);
        std::lock_guard lock(m_device.kernels_mutex);
        m_device.kernels.try_emplace(make_key(source), std::move(kernel));
        return;
    }
    const std::string hash = hash_machine_code(m_device, source);
    if (is_marked_compiled(hash))
        return;
    if (!rehearsal) {
        rehearsal = std::make_unique<Device>(std::to_string(m_device.info.index));
        rehearsal->impl().is_rehearsal = true;
    }
    const std::uintmax_t bytes = measure_driver_cache();
    dispatch_nothing(*rehearsal, source);
    wait_for_write(bytes);
    mark_compiled(hash);
}

void Device::compile_ahead(const std::vector<KernelSource>& sources) {
    m_impl->ahead->add(sources);
}

} // namespace photonloupe::gpu
