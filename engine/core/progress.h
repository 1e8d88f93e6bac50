// SPDX-License-Identifier: Apache-2.0
// How long work reports how far it is and learns that it should stop.
#pragma once

#include <functional>
#include <string_view>

#include "core/error.h"

namespace photonloupe {

// Called between chunks of work with the stage's name and the fraction done in [0, 1].
// Returning false stops the work with `Cancelled`; nothing half-made survives.
struct Progress {
    std::function<bool(std::string_view stage, double fraction)> callback;

    void report(std::string_view stage, double fraction) const {
        if (callback && !callback(stage, fraction))
            throw Cancelled(std::string(stage) + ": stopped on request");
    }
};

} // namespace photonloupe
