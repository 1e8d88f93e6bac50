// SPDX-License-Identifier: Apache-2.0
// One small dispatch that shows the device computes what it should.
#pragma once

#include "gpu/device.h"

namespace photonloupe::gpu {

struct SelfTest {
    bool ok = false;
    double milliseconds = 0; // the whole round trip, driver compilation included
    std::string message;     // what was wrong; empty when ok
};

// Squares numbers and checks that x - x of an infinity is NaN and that a compensated sum keeps its compensation.
SelfTest run_self_test(Device& device);

} // namespace photonloupe::gpu
