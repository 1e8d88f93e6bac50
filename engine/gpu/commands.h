// SPDX-License-Identifier: Apache-2.0
// Records dispatches and copies, submits them, and waits with a deadline; cuts long work into chunks.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/progress.h"
#include "gpu/buffer.h"
#include "gpu/device.h"
#include "gpu/kernel_source.h"
#include "gpu/texture.h"

namespace photonloupe::gpu {

// A buffer under the name the kernel declares it by.
struct Binding {
    std::string_view name;
    const Buffer& buffer;
};

// One batch of work. Steps run in the order recorded, each seeing what the one before wrote.
class Commands {
public:
    struct Impl;
    // `stage` names the work in timings, messages and deadlines.
    Commands(Device& device, std::string stage);
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    template <class Push>
    void dispatch(const KernelSource& kernel, const std::vector<Binding>& bindings, const Push& push,
                  std::uint64_t invocations) {
        static_assert(!std::is_convertible_v<Push, std::span<const std::byte>>);
        record_dispatch(kernel, bindings, &push, sizeof(Push), invocations);
    }
    // The same with push constants of a type that is not known before the run.
    void dispatch_bytes(const KernelSource& kernel, std::span<const Binding> bindings, std::span<const std::byte> push,
                        std::uint64_t invocations) {
        record_dispatch(kernel, bindings, push.data(), static_cast<std::uint32_t>(push.size()), invocations);
    }
    void copy(const Buffer& source, std::uint64_t source_offset, const Buffer& target, std::uint64_t target_offset,
              std::uint64_t size_bytes);
    void copy(const Buffer::Impl& source, std::uint64_t source_offset, const Buffer::Impl& target,
              std::uint64_t target_offset, std::uint64_t size_bytes); // staging, inside engine/gpu
    void fill(const Buffer& target, std::uint32_t value);

    // RGBA8 pixels, row 0 at the top, into a texture and out of it.
    void copy(const Buffer& pixels, Texture& target);
    void copy(Texture& source, const Buffer& pixels);
    // Clears the texture and draws; `record` gets a VkCommandBuffer within dynamic rendering.
    void draw(Texture& target, const std::function<void(void* command_buffer)>& record);

    // Submits and waits. Throws DeviceError naming the stage when the deadline passes or the device is lost,
    // and with the layer's message when validation speaks. Returns milliseconds on the device.
    double run();

    Impl& impl() const { return *m_impl; }

private:
    void record_dispatch(const KernelSource& kernel, std::span<const Binding> bindings, const void* push,
                         std::uint32_t push_bytes, std::uint64_t invocations);
    std::unique_ptr<Impl> m_impl;
};

// Runs one step by itself.
void fill(Device& device, const std::string& stage, const Buffer& target, std::uint32_t value);
void copy(Device& device, const std::string& stage, const Buffer& source, const Buffer& target,
          std::uint64_t size_bytes);
template <class Push>
void dispatch(Device& device, const std::string& stage, const KernelSource& kernel,
              const std::vector<Binding>& bindings, const Push& push, std::uint64_t invocations) {
    Commands commands(device, stage);
    commands.dispatch(kernel, bindings, push, invocations);
    commands.run();
}

// Runs `record(commands, first, count)` over [0, total) in chunks that are multiples of `granule` and aim at
// the device's chunk_milliseconds() each and never exceed `largest` (0: what one dispatch of an invocation per item
// allows), reporting progress between them. How work is cut never changes its result.
void run_in_chunks(Device& device, const std::string& stage, std::uint64_t total, std::uint64_t granule,
                   const Progress& progress,
                   const std::function<void(Commands&, std::uint64_t first, std::uint64_t count)>& record,
                   std::uint64_t largest = 0);

// Runs a kernel that way whose push constants say `first` and `count`.
template <class Push>
void dispatch_in_chunks(Device& device, const std::string& stage, const KernelSource& kernel,
                        const std::vector<Binding>& bindings, Push push, std::uint64_t total, std::uint64_t granule,
                        const Progress& progress) {
    run_in_chunks(device, stage, total, granule, progress,
                  [&](Commands& commands, std::uint64_t first, std::uint64_t count) {
                      push.first = static_cast<std::uint32_t>(first);
                      push.count = static_cast<std::uint32_t>(count);
                      commands.dispatch(kernel, bindings, push, count);
                  });
}

} // namespace photonloupe::gpu
