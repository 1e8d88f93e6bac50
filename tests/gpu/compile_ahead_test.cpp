// SPDX-License-Identifier: Apache-2.0
// Kernels compiled in the background are the same kernels; what goes wrong there is met where they are used.
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "gpu/compile_ahead.h"
#include "gpu/device_impl.h"
#include "gpu/driver_cache.h"
#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

// A number that no kernel of an earlier run had: no cache holds what is made with it.
std::uint32_t find_salt() {
    static const std::uint32_t salt = std::random_device{}() >> 8;
    return salt;
}

// Computes input × number + salt.
gpu::KernelSource make_kernel(const std::string& name, std::uint32_t number, const std::string& mistake = "") {
    return {"test/" + name,
            64,
            {},
            {number},
            R"(#include "shared/prelude.glsl"
layout(constant_id = 1) const uint NUMBER = 0u;
#pragma binding readonly uint inputs
#pragma binding writeonly uint outputs
layout(push_constant) uniform Push { uint count; };
void main() {
    if (gl_GlobalInvocationID.x < count) outputs[0] = inputs[0] * NUMBER + )" +
                std::to_string(find_salt()) + "u;" + mistake + "\n}\n"};
}

std::vector<gpu::KernelSource> make_kernels(const std::string& name, std::uint32_t count) {
    std::vector<gpu::KernelSource> kernels;
    for (std::uint32_t number = 0; number < count; ++number)
        kernels.push_back(make_kernel(name, number));
    return kernels;
}

std::uint32_t run_kernel(gpu::Device& device, const gpu::KernelSource& kernel) {
    const gpu::Buffer inputs = gpu::make_buffer(device, std::vector<std::uint32_t>{10}, "inputs");
    const gpu::Buffer outputs(device, sizeof(std::uint32_t), "outputs");
    gpu::Commands commands(device, "probe");
    commands.dispatch(kernel, {{"inputs", inputs}, {"outputs", outputs}}, std::uint32_t{1}, 1);
    commands.run();
    return outputs.read<std::uint32_t>(1)[0] - find_salt();
}

void finish(gpu::Device& device) {
    device.impl().ahead->finish();
}

TEST(CompileAhead, kernels_compute_the_same) {
    gpu::Device& device = get_device();
    const std::vector<gpu::KernelSource> kernels = make_kernels("ahead.comp", 6);
    device.compile_ahead(kernels);
    finish(device);
    for (std::uint32_t number = 0; number < kernels.size(); ++number)
        EXPECT_EQ(run_kernel(device, kernels[number]), 10 * number);
}

TEST(CompileAhead, kernels_may_be_used_while_they_are_compiled) {
    gpu::Device& device = get_device();
    const std::vector<gpu::KernelSource> kernels = make_kernels("used.comp", 6);
    device.compile_ahead(kernels);
    EXPECT_EQ(run_kernel(device, kernels[0]), 0u); // a thread is at it
    for (std::uint32_t number = 5; number > 0; --number)
        EXPECT_EQ(run_kernel(device, kernels[number]), 10 * number); // the last still waits
    finish(device);
}

TEST(CompileAhead, mistakes_are_reported_where_the_kernel_is_used) {
    gpu::Device& device = get_device();
    const gpu::KernelSource wrong = make_kernel("wrong.comp", 3, " nonsense"), right = make_kernel("right.comp", 3);
    const gpu::KernelSource missing{"test/there_is_none.comp", 64, {}, {}};
    device.compile_ahead({wrong, missing, right});
    finish(device);
    EXPECT_THROW(run_kernel(device, wrong), Error);
    EXPECT_THROW(run_kernel(device, missing), Error);
    EXPECT_EQ(run_kernel(device, right), 30u);
}

TEST(CompileAhead, a_device_may_be_closed_while_kernels_are_compiled) {
    for (const bool uses_one : {false, true}) {
        gpu::Device device;
        const std::vector<gpu::KernelSource> kernels = make_kernels(uses_one ? "closed.comp" : "unused.comp", 8);
        device.compile_ahead(kernels);
        if (uses_one)
            EXPECT_EQ(run_kernel(device, kernels[1]), 10u);
    }
}

TEST(CompileAhead, a_lost_device_can_be_closed_too) {
    gpu::Device device;
    device.compile_ahead(make_kernels("lost.comp", 4));
    device.impl().lost_because = "for the test";
    EXPECT_THROW(run_kernel(device, make_kernel("lost.comp", 1)), DeviceError);
}

TEST(CompileAhead, what_the_software_device_has_compiled_is_marked) {
    gpu::Device& device = get_device();
    if (device.info().type != "software")
        return; // others keep the pipeline itself
    const gpu::KernelSource ahead = make_kernel("mark.comp", 1), never = make_kernel("mark.comp", 2);
    device.compile_ahead({ahead});
    finish(device);
    EXPECT_TRUE(gpu::is_marked_compiled(gpu::hash_machine_code(device.impl(), ahead)));
    EXPECT_FALSE(gpu::is_marked_compiled(gpu::hash_machine_code(device.impl(), never)));
}

TEST(CompileAhead, nothing_is_compiled_when_it_is_switched_off) {
    const ScopedVariable off("PHOTONLOUPE_COMPILE_AHEAD", "0");
    gpu::Device device;
    const gpu::KernelSource kernel = make_kernel("off.comp", 5);
    device.compile_ahead({kernel});
    finish(device);
    EXPECT_FALSE(gpu::is_marked_compiled(gpu::hash_machine_code(device.impl(), kernel)));
    EXPECT_EQ(run_kernel(device, kernel), 50u);
}

} // namespace
} // namespace photonloupe::test
