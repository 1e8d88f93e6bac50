// SPDX-License-Identifier: Apache-2.0
// Names a kernel of shaders/ and expands its text: includes once, and `#pragma binding` lines into declarations.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace photonloupe::gpu {

// What to compile: a file below shaders/, structural defines, and numbers as specialisation constants 1, 2, …
// (constant 0 is the workgroup's size).
struct KernelSource {
    std::string path;                     // "trace/shoot_photons.comp"
    std::uint32_t workgroup_size = 64;    // 0: one subgroup
    std::vector<std::string> defines;     // "HAS_DIELECTRIC", "METRIC 2"
    std::vector<std::uint32_t> constants; // constant_id 1, 2, …
    std::string text;                     // generated kernels: what would be the file's content
};

enum class BindingKind { storage, texel };

// One `#pragma binding [readonly|writeonly] TYPE NAME` or `#pragma binding texel NAME`, in order of appearance.
struct BindingDeclaration {
    BindingKind kind = BindingKind::storage;
    std::string qualifier;
    std::string type;
    std::string name;
};

struct ExpandedSource {
    std::string text; // includes inlined, each once, with #line marks; binding pragmas still in place
    std::vector<BindingDeclaration> bindings;
};

// Tells sources apart, whatever their files hold.
std::string make_key(const KernelSource& source);

// Reads a kernel, or takes its text, with the files it includes. Throws Error naming the file and line.
ExpandedSource expand_source(const KernelSource& source);

// The text glslang gets. `by_address` has a bit for each binding whose buffer is too large for a descriptor.
std::string declare_bindings(const ExpandedSource& source, const std::vector<std::string>& defines,
                             std::uint64_t by_address);

// A kernel's SPIR-V with all its buffers in descriptors; needs no device.
std::vector<std::uint32_t> compile_generated(const KernelSource& source);

} // namespace photonloupe::gpu
