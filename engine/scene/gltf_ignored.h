// SPDX-License-Identifier: Apache-2.0
// Lists what a scene file contains that nothing here models, so that no result is wrong in silence.
#pragma once

#include <string>
#include <vector>

#include "core/json_place.h"

namespace photonloupe {

// One sentence per feature, by name and with the places or the count.
std::vector<std::string> list_ignored_features(const JsonPlace& root, bool is_animated);

// Extensions that are read.
bool is_known_extension(std::string_view name);
// Extensions of looks or of data about the file: the surfaces stay where they are without them. Any other that is not
// known is refused in `extensionsRequired`.
bool is_dispensable_extension(std::string_view name);

} // namespace photonloupe
