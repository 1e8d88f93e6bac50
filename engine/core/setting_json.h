// SPDX-License-Identifier: Apache-2.0
// Settings as JSON: what holds nothing is written by its name.
#pragma once

#include "core/json_place.h"
#include "core/settings.h"

namespace photonloupe {

Json write_json(const Setting& setting);
// By their labels.
Json write_json(const std::vector<Setting>& settings);

// Why the setting may not be what the file says, as what follows its name; empty: it is now.
std::string read_json(const Setting& setting, const Json& given);

} // namespace photonloupe
