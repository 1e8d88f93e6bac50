// SPDX-License-Identifier: Apache-2.0
// Compiles the editor's text whenever it changed.
#include "studio/script_document.h"

#include <algorithm>

namespace photonloupe::studio {

void ScriptDocument::check(const std::string& text, const std::string& name) {
    if (m_compiled && text == m_text)
        return;
    m_text = text;
    m_compiled = script::compile_script({name, text});
    ++m_version;
}

std::size_t ScriptDocument::count_errors() const {
    if (!m_compiled)
        return 0;
    return static_cast<std::size_t>(std::count_if(
        m_compiled->diagnostics.begin(), m_compiled->diagnostics.end(),
        [](const script::Diagnostic& diagnostic) { return diagnostic.severity == script::Severity::error; }));
}

} // namespace photonloupe::studio
