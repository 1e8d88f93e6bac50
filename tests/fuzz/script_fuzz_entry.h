// SPDX-License-Identifier: Apache-2.0
// What both the libFuzzer target and the seeded test do with any bytes: check them as a script.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "script/check_script.h"

namespace photonloupe::test {

inline void fuzz_script(const std::uint8_t* data, std::size_t size) {
    const script::Source source{"fuzz", std::string(reinterpret_cast<const char*>(data), size)};
    script::Diagnostics diagnostics;
    const script::Program program = script::check_script(source, diagnostics);
    script::format_diagnostics(source, diagnostics.sorted());
}

} // namespace photonloupe::test
