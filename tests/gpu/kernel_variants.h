// SPDX-License-Identifier: Apache-2.0
// Every kernel of shaders/ with every combination of defines the engine asks for.
#pragma once

#include <string>
#include <vector>

namespace photonloupe::test {

struct KernelVariant {
    std::string path;
    std::vector<std::string> defines;
};

// Paths of all `.comp` files, relative to shaders/.
std::vector<std::string> list_kernels();

std::vector<KernelVariant> list_variants();

} // namespace photonloupe::test
