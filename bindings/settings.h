// SPDX-License-Identifier: Apache-2.0
// Settings from Python's dictionaries: what is not given keeps its default, what may not be is refused by name.
#pragma once

#include "binding.h"

#include "core/settings.h"

namespace photonloupe::bindings {

nb::dict write_rows(const std::vector<Setting>& rows);
void read_rows(const std::vector<Setting>& rows, const nb::dict& given);

template <class Settings>
Settings read_settings(const nb::dict& given) {
    Settings settings;
    read_rows(list_settings(settings), given);
    return settings;
}

} // namespace photonloupe::bindings
