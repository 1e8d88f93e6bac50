// SPDX-License-Identifier: Apache-2.0
// The device all tests share, and what they need to run kernels of their own on it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/commands.h"

namespace photonloupe::test {

// Opened at first use by "auto", kept to the end of the process.
gpu::Device& get_device();

// Sets an environment variable and puts the old value back.
class ScopedVariable {
public:
    ScopedVariable(const char* name, const std::string& value);
    ~ScopedVariable();
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

private:
    const char* m_name;
    std::optional<std::string> m_old;
};

// Runs a probe kernel once over its `inputs`: it reads them by that name and writes as many `outputs`.
// Push constant: the count, as uint.
template <class Out, class In>
std::vector<Out> run_probe(gpu::Device& device, const std::string& path, const std::vector<In>& inputs,
                           const std::vector<std::string>& defines = {}) {
    const gpu::Buffer input = gpu::make_buffer(device, inputs, "probe inputs");
    const gpu::Buffer output(device, inputs.size() * sizeof(Out), "probe outputs");
    const auto count = static_cast<std::uint32_t>(inputs.size());
    gpu::Commands commands(device, "probe");
    commands.dispatch({path, 64, defines, {}}, {{"inputs", input}, {"outputs", output}}, count, count);
    commands.run();
    return output.read<Out>(inputs.size());
}

} // namespace photonloupe::test
