// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes are a session or are refused; what is taken survives being written.
#include "session_fuzz_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    photonloupe::test::fuzz_session(data, size);
    return 0;
}
