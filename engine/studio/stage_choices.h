// SPDX-License-Identifier: Apache-2.0
// The stages' settings as the studio offers them, and what stands for those that are automatic.
#pragma once

#include "core/settings.h"
#include "studio/state.h"

namespace photonloupe::studio {

// Of rendering, without what the view decides.
std::vector<Setting> list_choices(ImageState& image);

// The choices with the number of steps decided.
RelaxSettings decide_steps(const StudioState& state);
RelaxSettings complete_choices(const StudioState& state, bool has_parameters);
ImageState complete_choices(ImageState image, const TraceState& trace);

} // namespace photonloupe::studio
