// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes are a script or are refused with diagnostics.
#include "script_fuzz_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    photonloupe::test::fuzz_script(data, size);
    return 0;
}
