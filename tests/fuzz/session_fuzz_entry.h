// SPDX-License-Identifier: Apache-2.0
// What both the libFuzzer target and the seeded test do with any bytes: read them as a session, and write what was
// read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "studio/session.h"

namespace photonloupe::test {

// Taken or refused with Error; what was taken is written and read again as the same.
inline void fuzz_session(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    studio::StudioState state;
    try {
        state = studio::read_state(text, "/folder");
    } catch (const Error&) {
        return;
    }
    const std::string written = studio::write_state(state, "/folder");
    if (studio::write_state(studio::read_state(written, "/folder"), "/folder") != written)
        std::abort();
}

} // namespace photonloupe::test
