// SPDX-License-Identifier: Apache-2.0
// Which work the state asks for that has not been done: what runs in the background, in the order of the main flow.
#pragma once

#include <map>
#include <optional>
#include <sstream>
#include <string>

#include "studio/camera.h"

namespace photonloupe::studio {

// A text that differs where one of the values does.
template <class... Values>
std::string write_values(const Values&... values) {
    std::ostringstream text;
    text << std::hexfloat;
    ((text << values << '\n'), ...);
    return text.str();
}
std::string write_pose(const CameraPose& pose);

// A piece of work for whoever runs the stages: what was chosen when it was asked for.
struct Job {
    std::string kind; // trace, map, script, relax, isotropy, render, reference
    std::string key;  // of all that decides its result
    StudioState state;
    CameraPose camera;
};

// What has been done, or has failed and waits for a change: job kind to key.
using DoneWork = std::map<std::string, std::string>;

// What else may be asked for beside the state's own stages.
struct Wanted {
    bool image = false;    // a rendered picture
    bool isotropy = false; // of the parameters
};

// What earlier work has left.
struct Holding {
    bool photons = false; // false though they were traced: that failed, and nothing can follow
    bool scene = false;
    bool parameters = false;
    std::uint64_t photons_version = 0;
};

// The first stage that is not up to date, or nothing.
std::optional<Job> plan_work(const StudioState& state, const CameraPose& camera, const Wanted& wanted,
                             const Holding& holding, const DoneWork& done);

} // namespace photonloupe::studio
