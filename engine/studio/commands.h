// SPDX-License-Identifier: Apache-2.0
// Everything a key or a menu can do, by name: one table for keys, help, menus and Python.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "studio/workspace.h"

namespace photonloupe::studio {

struct Command {
    std::string_view name;  // "loupe.pin"
    std::string_view keys;  // "ctrl+enter"; empty: none
    std::string_view about; // one sentence
    bool works_in_text;     // also while a text is edited
    void (*run)(Workspace&);
};

std::span<const Command> list_commands();

// Throws Error naming those there are.
const Command& find_command(std::string_view name);

// Runs those whose keys were pressed in this frame.
void run_pressed_commands(Workspace& workspace);

// ImGui's key chord of a text such as "ctrl+shift+z". Throws Error for a key that is not known.
int parse_chord(std::string_view text);

} // namespace photonloupe::studio
