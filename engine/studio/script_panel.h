// SPDX-License-Identifier: Apache-2.0
// The script: editor with what is wrong marked in it, a slider per exposed variable, the report of the last run.
#pragma once

#include <TextEditor.h>

#include "studio/workspace.h"

namespace photonloupe::studio {

class ScriptPanel {
public:
    explicit ScriptPanel(const Workspace& workspace);
    void draw(Workspace& workspace);

private:
    void draw_toolbar(Workspace& workspace);
    void draw_editor(Workspace& workspace);
    void draw_sliders(Workspace& workspace);
    void draw_report(Workspace& workspace);
    void mark_diagnostics(const ScriptDocument& document);

    TextEditor m_editor;
    std::string m_text;  // as the editor and the state last agreed on
    std::string m_shown; // what the editor made of it
    std::string m_path;  // in the field
    std::uint64_t m_marked_version = 0;
};

} // namespace photonloupe::studio
